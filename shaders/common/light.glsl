// Studio light shared by all passes that draw solid things. CPU twin: render/gl/gl_light.h.
// Inputs in world space, unit vectors; output linear radiance.
uniform vec3 u_eye;            // metres, world
uniform vec3 u_to_eye;         // unit, towards the eye of an orthographic camera; zero for a pinhole
uniform vec3 u_key, u_fill;    // unit, towards the lamps
uniform vec3 u_key_light, u_fill_light;  // linear radiance
uniform vec3 u_ground, u_sky;  // linear radiance of the dome

vec3 direction_to_eye(vec3 p) { return dot(u_to_eye, u_to_eye) > 0.0 ? u_to_eye : normalize(u_eye - p); }

// How much of a broad lamp in direction `to_light` a lobe of `sharpness` around `dir` sees.
float soft_box(vec3 dir, vec3 to_light, float sharpness) {
    return exp(sharpness * (dot(dir, to_light) - 1.0));
}

// Light from a direction: dim dome, brighter above, one large key light and one fill.
vec3 surroundings(vec3 dir, float roughness) {
    float sharp = mix(90.0, 5.0, roughness);
    vec3 dome = mix(u_ground, u_sky, 0.5 + 0.5 * dir.z);
    return dome + 5.0 * u_key_light * soft_box(dir, u_key, sharp) + 5.0 * u_fill_light * soft_box(dir, u_fill, sharp);
}

// The same, gathered by a diffuse surface with normal n.
vec3 irradiance(vec3 n) {
    vec3 dome = mix(u_ground, u_sky, 0.5 + 0.35 * n.z);
    float k = max(0.0, 0.15 + 0.85 * dot(n, u_key)), f = max(0.0, 0.25 + 0.75 * dot(n, u_fill));
    return dome + u_key_light * k + u_fill_light * f;
}

// Schlick's Fresnel for a clear coat of index 1.5.
float coat_fresnel(float cos_view) { return 0.04 + 0.96 * pow(1.0 - clamp(cos_view, 0.0, 1.0), 5.0); }

vec3 encode_srgb(vec3 c) {
    c = clamp(c, 0.0, 1.0);
    return mix(12.92 * c, 1.055 * pow(c, vec3(1.0 / 2.4)) - 0.055, step(0.0031308, c));
}
