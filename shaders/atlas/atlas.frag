// The atlas as a flat picture. Input: uv. Output: sRGB colour.
#version 330 core
#include "common/ramp.glsl"
in vec2 v_uv;
uniform sampler2D u_texture;         // as in mesh.frag
uniform samplerBuffer u_triangle_colours;
uniform int u_shading;               // as in mesh.frag; what needs light is shown as flat colour
uniform float u_atlas_size, u_height_range;
out vec4 f_colour;

vec3 encode_srgb(vec3 c) { return mix(12.92 * c, 1.055 * pow(c, vec3(1.0 / 2.4)) - 0.055, step(0.0031308, c)); }

void main() {
    if (u_shading == 5) {
        f_colour = vec4(texelFetch(u_triangle_colours, gl_PrimitiveID).rgb, 1.0);
        return;
    }
    vec4 texel = texture(u_texture, v_uv);
    if (u_shading == 3) {
        f_colour = vec4(height_colour(ink_height(texel.a), u_height_range), 1.0);
        return;
    }
    float pattern = u_shading == 4 ? texel_pattern(v_uv, u_atlas_size) : 1.0;
    f_colour = vec4(encode_srgb(texel.rgb * pattern), 1.0);
}
