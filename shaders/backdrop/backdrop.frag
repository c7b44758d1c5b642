// Seamless backdrop behind the model, lighter in the middle. Output: sRGB colour, dithered.
#version 330 core
in float v_height;
uniform vec3 u_low, u_high;  // sRGB-encoded
out vec4 f_colour;
void main() {
    float noise = fract(sin(dot(gl_FragCoord.xy, vec2(12.9898, 78.233))) * 43758.5453) - 0.5;
    f_colour = vec4(mix(u_low, u_high, smoothstep(0.0, 1.0, v_height)) + noise / 255.0, 1.0);
}
