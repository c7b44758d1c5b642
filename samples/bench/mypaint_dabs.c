/* Dabs a second of libmypaint on a flat canvas: one straight stroke, dabs counted as the surface gets them.
   usage: mypaint_dabs WIDTH DABS; prints JSON. */
#include <math.h>
#include <mypaint-brush.h>
#include <mypaint-fixed-tiled-surface.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

static long dabs = 0;
static MyPaintSurfaceDrawDabFunction draw;

static int count_dab(MyPaintSurface* self, float x, float y, float radius, float r, float g, float b, float opaque,
                     float hardness, float alpha, float ratio, float angle, float lock, float colorize) {
    ++dabs;
    return draw(self, x, y, radius, r, g, b, opaque, hardness, alpha, ratio, angle, lock, colorize);
}

static double cpu_seconds(void) {
    struct timespec t;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

int main(int argc, char** argv) {
    if (argc != 3) return 2;
    const float width = (float)atof(argv[1]);
    const long wanted = atol(argv[2]);
    MyPaintFixedTiledSurface* canvas = mypaint_fixed_tiled_surface_new(4096, 4096);
    MyPaintSurface* surface = mypaint_fixed_tiled_surface_interface(canvas);
    draw = surface->draw_dab;
    surface->draw_dab = count_dab;
    MyPaintBrush* brush = mypaint_brush_new();
    mypaint_brush_from_defaults(brush);
    mypaint_brush_set_base_value(brush, MYPAINT_BRUSH_SETTING_RADIUS_LOGARITHMIC, logf(0.5f * width));
    /* A dab a pixel. */
    mypaint_brush_set_base_value(brush, MYPAINT_BRUSH_SETTING_DABS_PER_ACTUAL_RADIUS, 0.5f * width);
    mypaint_brush_set_base_value(brush, MYPAINT_BRUSH_SETTING_DABS_PER_BASIC_RADIUS, 0);
    const double start = cpu_seconds();
    for (int line = 0; dabs < wanted; ++line) {
        mypaint_brush_reset(brush);
        mypaint_brush_new_stroke(brush);
        mypaint_surface_begin_atomic(surface);
        for (int i = 0; i <= 400 && dabs < wanted; ++i)
            mypaint_brush_stroke_to(brush, surface, 500.0f + 4 * (float)i, 500.0f + 40 * (float)(line % 70), 1, 0, 0, 0.004);
        MyPaintRectangle changed;
        mypaint_surface_end_atomic(surface, &changed);
    }
    printf("{\"program\": \"libmypaint\", \"texels\": %g, \"stamps_per_second\": %.0f}\n", (double)width,
           (double)dabs / (cpu_seconds() - start));
    return 0;
}
