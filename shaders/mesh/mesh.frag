// Model surface: body colour from the atlas under a coat and studio light, or one of the
// plain views. Input: world position and normal, uv. Output: sRGB colour.
// Relief from screen derivatives after Mikkelsen 2010, "Bump mapping unparametrized surfaces".
#version 330 core
#include "common/light.glsl"
#include "common/ramp.glsl"
in vec3 v_position;
in vec3 v_normal;
in vec2 v_uv;
uniform sampler2D u_texture;         // sRGB colour (the GPU decodes), alpha: code of the height
uniform samplerBuffer u_triangle_colours;  // sRGB-encoded, one per triangle
uniform float u_roughness;           // of the coat
uniform int u_shading;               // 0 glaze, 1 clay, 2 flat colour, 3 height, 4 texel grid, 5 triangle colours
uniform float u_atlas_size;          // texels per side
uniform float u_relief;              // times that thin ink is shown as high as it is
uniform float u_height_range;        // micrometres at the ramp's end
uniform float u_transmission;        // part of the light that passes where there is no ink; 0: opaque
out vec4 f_colour;

vec3 relief_normal(vec3 n, float height) {
    vec3 px = dFdx(v_position), py = dFdy(v_position);
    vec3 r1 = cross(py, n), r2 = cross(n, px);
    float det = dot(px, r1);
    vec3 slope = sign(det) * (dFdx(height) * r1 + dFdy(height) * r2);
    return normalize(abs(det) * n - slope);
}

// Metres: thin ink is shown higher than it is, thick paint as it is.
float shown_height(float micrometres) { return 1e-6 * (micrometres + (u_relief - 1.0) * 20.0 * (1.0 - exp(-micrometres / 20.0))); }

void main() {
    vec3 n = normalize(v_normal);
    vec3 to_eye = direction_to_eye(v_position);
    if (dot(n, to_eye) < 0.0) n = -n;
    float facing = 0.35 + 0.65 * dot(n, to_eye);
    if (u_shading == 5) {
        f_colour = vec4(texelFetch(u_triangle_colours, gl_PrimitiveID).rgb * facing, 1.0);
        return;
    }
    vec4 texel = texture(u_texture, v_uv);
    if (u_shading == 2) {
        f_colour = vec4(encode_srgb(texel.rgb), 1.0);
        return;
    }
    if (u_shading == 3) {
        f_colour = vec4(height_colour(ink_height(texel.a), u_height_range) * facing, 1.0);
        return;
    }
    vec3 base = texel.rgb;
    if (u_shading == 4) base *= texel_pattern(v_uv, u_atlas_size);
    if (u_relief > 0.0) n = relief_normal(n, shown_height(ink_height(texel.a)));
    float fresnel = u_shading == 1 ? 0.0 : mix(coat_fresnel(dot(n, to_eye)), 0.02, smoothstep(0.4, 0.8, u_roughness));
    vec3 light = (1.0 - fresnel) * base * irradiance(n);
    vec3 mirrored = vec3(0.0);
    if (fresnel > 0.0) mirrored = fresnel * surroundings(reflect(-to_eye, n), u_transmission > 0.0 ? 0.05 : u_roughness);
    light += mirrored;
    float passes = 0.0;
    if (u_transmission > 0.0) {
        // Ink hides by exp(-4) per film unit of 2.5 micrometres. What is mirrored covers what is behind.
        float bright = clamp(max(mirrored.r, max(mirrored.g, mirrored.b)), 0.0, 1.0);
        passes = u_transmission * (1.0 - bright) * exp(-ink_height(texel.a) / 0.625);
    }
    f_colour = vec4(encode_srgb(light), 1.0 - passes);
}
