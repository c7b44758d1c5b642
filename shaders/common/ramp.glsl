// Micrometres of ink for the texture's fourth channel, as `height_of_code` in gl_scene.h.
float ink_height(float channel) { return 4.8 * (exp(channel * (255.0 / 48.0)) - 1.0); }

// Five-step ramp from dark blue to pale yellow, even in lightness. Linear values in, t in [0, 1].
vec3 ramp(float t) {
    vec3 c0 = vec3(0.13, 0.12, 0.30), c1 = vec3(0.18, 0.37, 0.55), c2 = vec3(0.16, 0.60, 0.55), c3 = vec3(0.55, 0.79, 0.32),
         c4 = vec3(0.99, 0.91, 0.40);
    float x = clamp(t, 0.0, 1.0) * 4.0;
    return x < 1.0 ? mix(c0, c1, x) : x < 2.0 ? mix(c1, c2, x - 1.0) : x < 3.0 ? mix(c2, c3, x - 2.0) : mix(c3, c4, x - 3.0);
}

// Colour of ink of a height in micrometres; bare parts are grey, a film shows from a twentieth on.
vec3 height_colour(float height, float range) { return mix(vec3(0.80), ramp(height / range), smoothstep(0.02, 0.15, height)); }

// Darkens every other texel where they are seen, and every other tile of 16 of them.
float texel_pattern(vec2 uv, float atlas_size) {
    vec2 t = uv * atlas_size;
    vec2 cell = floor(t), wide = floor(t / 16.0);
    float width = max(fwidth(t.x), fwidth(t.y));
    float fine = mod(cell.x + cell.y, 2.0), coarse = mod(wide.x + wide.y, 2.0);
    return mix(mix(0.72, 1.0, fine), 0.86, smoothstep(0.35, 0.9, width)) * mix(0.85, 1.0, coarse);
}
