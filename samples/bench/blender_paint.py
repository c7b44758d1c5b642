"""Stamps a second of Blender's texture paint on a sphere, as `tuft bench` measures them: dots a texel apart along the
equator, on a texture of SIZE texels. Started by compare.sh: blender --python blender_paint.py -- SIZE WIDTH STAMPS OUT.
It needs a window (xvfb-run): texture paint does not run in the background."""
import json
import math
import sys
import time

import bpy

size, width, stamps, out = (int(a) if a.isdigit() else a for a in sys.argv[sys.argv.index("--") + 1:])
RADIUS = 0.05


def build():
    bpy.ops.object.select_all(action="SELECT")
    bpy.ops.object.delete()
    # 99,540 triangles with the UVs of a globe.
    bpy.ops.mesh.primitive_uv_sphere_add(segments=316, ring_count=158, radius=RADIUS)
    sphere = bpy.context.object
    image = bpy.data.images.new("paint", size, size)
    material = bpy.data.materials.new("paint")
    material.use_nodes = True
    node = material.node_tree.nodes.new("ShaderNodeTexImage")
    node.image = image
    material.node_tree.nodes.active = node
    sphere.data.materials.append(material)
    bpy.ops.object.mode_set(mode="TEXTURE_PAINT")
    settings = bpy.context.tool_settings.image_paint
    settings.mode = "IMAGE"
    settings.canvas = image
    settings.seam_bleed = 2
    return settings.brush


def look(area):
    """Orthographic from the front; returns pixels of the region for a metre."""
    space = area.spaces.active
    view = space.region_3d
    view.view_perspective = "ORTHO"
    view.view_rotation = (math.sqrt(0.5), math.sqrt(0.5), 0, 0)
    view.view_location = (0, 0, 0)
    view.view_distance = 0.15
    view.update()


def measure():
    brush = build()
    window = bpy.context.window_manager.windows[0]
    area = next(a for a in window.screen.areas if a.type == "VIEW_3D")
    region = next(r for r in area.regions if r.type == "WINDOW")
    look(area)
    bpy.ops.wm.redraw_timer(type="DRAW_WIN_SWAP", iterations=1)
    from bpy_extras.view3d_utils import location_3d_to_region_2d
    from mathutils import Vector
    space = area.spaces.active.region_3d
    at = [location_3d_to_region_2d(region, space, Vector((x, -RADIUS, 0))) for x in (-0.01, 0.01)]
    pixels_per_metre = (at[1] - at[0]).length / 0.02
    # Texels of the globe at the equator, geometric mean of both directions.
    texel = math.sqrt((2 * math.pi * RADIUS / size) * (math.pi * RADIUS / size))
    brush.stroke_method = "DOTS"
    brush.size = max(1, round(0.5 * width * texel * pixels_per_metre))
    brush.use_pressure_size = False
    middle = 0.5 * (at[0] + at[1])
    points = [{
        "name": "", "mouse": (middle.x + (i - stamps / 2) * texel * pixels_per_metre, middle.y), "mouse_event": (0, 0),
        "pen_flip": False, "is_start": i == 0, "location": (0, 0, 0), "size": brush.size, "pressure": 1, "time": 0.001 * i,
        "x_tilt": 0, "y_tilt": 0
    } for i in range(stamps)]
    runs = []
    with bpy.context.temp_override(window=window, area=area, region=region):
        for _ in range(3):
            start = time.process_time()
            bpy.ops.paint.image_paint(stroke=points, mode="NORMAL")
            runs.append(time.process_time() - start)
    image = bpy.data.images["paint"]
    painted = sum(1 for v in list(image.pixels)[0::4] if v > 0)
    seconds = sorted(runs)[1]
    with open(out, "w", encoding="utf-8") as f:
        json.dump({"program": "Blender " + bpy.app.version_string, "texels": width, "stamps_per_second": stamps / seconds,
                   "brush_pixels": 2 * brush.size, "painted_texels": painted}, f)
    bpy.ops.wm.quit_blender()


def run():
    try:
        measure()
    except Exception as fault:  # pylint: disable=broad-except
        print("fault:", repr(fault), file=sys.stderr)
        bpy.ops.wm.quit_blender()


bpy.app.timers.register(run, first_interval=1.0)
