// Studio light shared by all passes that draw solid things. CPU twin: render/gl_light.h.
// Inputs in view-independent world space, unit vectors; output linear radiance.
uniform vec3 u_eye;          // metres, world
uniform mat3 u_light_frame;  // columns: right, up and forward of the camera, so lights follow it

// Soft box: how much of a broad lamp in direction `to_light` a lobe of `sharpness` around `dir` sees.
float soft_box(vec3 dir, vec3 to_light, float sharpness) {
    return exp(sharpness * (dot(dir, to_light) - 1.0));
}

// Light from a direction: dim dome, brighter above, one large key light and one fill.
vec3 surroundings(vec3 dir, float roughness) {
    float sharp = mix(90.0, 5.0, roughness);
    vec3 key = normalize(u_light_frame * vec3(-0.55, 0.75, -0.35));
    vec3 fill = normalize(u_light_frame * vec3(0.8, 0.15, -0.55));
    float up = 0.5 + 0.5 * dir.z;
    vec3 dome = mix(vec3(0.20, 0.195, 0.19), vec3(0.62, 0.64, 0.67), up);
    return dome + vec3(2.6, 2.55, 2.45) * soft_box(dir, key, sharp) + vec3(0.55, 0.6, 0.68) * soft_box(dir, fill, sharp);
}

// The same, gathered by a diffuse surface with normal n.
vec3 irradiance(vec3 n) {
    vec3 key = normalize(u_light_frame * vec3(-0.55, 0.75, -0.35));
    vec3 fill = normalize(u_light_frame * vec3(0.8, 0.15, -0.55));
    float up = 0.5 + 0.5 * n.z;
    vec3 dome = mix(vec3(0.26, 0.25, 0.24), vec3(0.50, 0.515, 0.54), up);
    float k = max(0.0, 0.15 + 0.85 * dot(n, key)), f = max(0.0, 0.25 + 0.75 * dot(n, fill));
    return dome + vec3(0.52, 0.51, 0.49) * k + vec3(0.10, 0.11, 0.125) * f;
}

// Schlick's Fresnel for a clear coat of index 1.5.
float coat_fresnel(float cos_view) { return 0.04 + 0.96 * pow(1.0 - clamp(cos_view, 0.0, 1.0), 5.0); }

vec3 encode_srgb(vec3 c) {
    c = clamp(c, 0.0, 1.0);
    return mix(12.92 * c, 1.055 * pow(c, vec3(1.0 / 2.4)) - 0.055, step(0.0031308, c));
}
