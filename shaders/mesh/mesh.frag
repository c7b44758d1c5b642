// Model surface under studio light: body colour from the atlas under a coat.
// Output: sRGB colour.
#version 330 core
#include "common/light.glsl"
in vec3 v_position;
in vec3 v_normal;
in vec2 v_uv;
uniform sampler2D u_base_colour;  // sRGB texture: the GPU decodes
uniform float u_roughness;        // of the coat
uniform int u_shading;            // 0 lit, 1 flat colour, 2 texel grid, 3 charts
uniform float u_atlas_size;       // texels per side
out vec4 f_colour;
void main() {
    vec3 n = normalize(v_normal);
    vec3 to_eye = normalize(u_eye - v_position);
    if (dot(n, to_eye) < 0.0) n = -n;
    vec3 base = texture(u_base_colour, v_uv).rgb;
    if (u_shading == 1) {
        f_colour = vec4(encode_srgb(base), 1.0);
        return;
    }
    if (u_shading == 2) {
        vec2 t = floor(v_uv * u_atlas_size);
        base *= mod(t.x + t.y, 2.0) < 0.5 ? 1.0 : 0.72;
    }
    float fresnel = mix(coat_fresnel(dot(n, to_eye)), 0.02, smoothstep(0.4, 0.8, u_roughness));
    vec3 mirror = reflect(-to_eye, n);
    vec3 light = (1.0 - fresnel) * base * irradiance(n) + fresnel * surroundings(mirror, u_roughness);
    f_colour = vec4(encode_srgb(light), 1.0);
}
