// The model's surface spread out in its atlas. Inputs: uv (v up); output: uv.
#version 330 core
layout(location = 2) in vec2 a_uv;
uniform vec4 u_window;  // centre of what is seen (uv), half its width and height (uv)
out vec2 v_uv;
void main() {
    v_uv = a_uv;
    gl_Position = vec4((a_uv - u_window.xy) / u_window.zw, 0.0, 1.0);
}
