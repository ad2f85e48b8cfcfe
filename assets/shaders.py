"""The renderer's GLSL: sunlit textured surfaces with haze, a clear sky, plain discs."""

_SKY = """
uniform vec3 sun;
vec3 sky(vec3 ray) {
    float up = clamp(ray.z, 0.0, 1.0);
    vec3 blue = mix(vec3(0.74, 0.83, 0.90), vec3(0.30, 0.51, 0.80), pow(up, 0.55));
    return blue + vec3(0.28, 0.24, 0.16) * pow(max(dot(ray, sun), 0.0), 24.0);
}
"""
SCENE_VERTEX = """
#version 330
uniform mat4 clip_site;
in vec3 position; in vec3 normal; in vec2 uv; in vec3 colour;
out vec3 at; out vec3 facing; out vec2 place; out vec3 tint;
void main() {
    at = position; facing = normal; place = uv; tint = colour;
    gl_Position = clip_site * vec4(position, 1.0);
}
"""
SCENE_FRAGMENT = (
    """
#version 330
uniform sampler2D surface;
uniform vec3 eye_m;
in vec3 at; in vec3 facing; in vec2 place; in vec3 tint;
out vec4 pixel;
"""
    + _SKY
    + """
const float HAZE_M = 2600.0;
void main() {
    vec3 away = at - eye_m;
    float far_m = length(away);
    vec3 n = normalize(facing);
    if (dot(n, away) > 0.0) n = -n;
    vec3 ambient = mix(vec3(0.34, 0.31, 0.27), vec3(0.42, 0.47, 0.55), 0.5 + 0.5 * n.z);
    vec3 light = ambient + vec3(0.78, 0.74, 0.66) * max(dot(n, sun), 0.0);
    vec3 lit = pow(texture(surface, place).rgb, vec3(2.2)) * tint * light;
    lit = pow(clamp(lit, 0.0, 1.0), vec3(1.0 / 2.2));
    vec3 air = sky(normalize(vec3(away.xy, 0.0) + vec3(0.0, 0.0, 1e-6)));
    pixel = vec4(mix(lit, air, 1.0 - exp(-far_m / HAZE_M)), 1.0);
}
"""
)
SKY_VERTEX = """
#version 330
uniform vec2 scale; uniform vec2 centre;
out vec2 ray;
void main() {
    vec2 corner = vec2(gl_VertexID & 1, gl_VertexID >> 1);
    ray = (corner - centre) * scale;
    gl_Position = vec4(corner * 2.0 - 1.0, 0.0, 1.0);
}
"""
SKY_FRAGMENT = (
    """
#version 330
uniform mat3 R_site_cam;
in vec2 ray;
out vec4 pixel;
"""
    + _SKY
    + """
void main() { pixel = vec4(sky(normalize(R_site_cam * vec3(ray, 1.0))), 1.0); }
"""
)
DISC_VERTEX = """
#version 330
uniform mat4 clip_cam;
in vec3 position; in vec3 colour;
out vec3 tint;
void main() { tint = colour; gl_Position = clip_cam * vec4(position, 1.0); }
"""
DISC_FRAGMENT = """
#version 330
in vec3 tint;
out vec4 pixel;
void main() { pixel = vec4(tint, 1.0); }
"""
