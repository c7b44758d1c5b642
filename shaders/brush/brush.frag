// Hair and ferrule: diffuse with a broad sheen. Output: sRGB colour with the brush's opacity.
#version 330 core
#include "common/light.glsl"
in vec3 v_position;
in vec3 v_normal;
in vec3 v_colour;
uniform float u_opacity;
out vec4 f_colour;
void main() {
    vec3 n = normalize(v_normal);
    vec3 to_eye = direction_to_eye(v_position);
    if (dot(n, to_eye) < 0.0) n = -n;
    vec3 light = v_colour * irradiance(n) + 0.06 * surroundings(reflect(-to_eye, n), 0.5);
    f_colour = vec4(encode_srgb(light), u_opacity);
}
