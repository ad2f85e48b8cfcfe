"""The renderer's GLSL: sunlit textured surfaces with shadows and haze, a summer sky, plain discs."""

_SKY = """
uniform vec3 sun;
uniform float brightness;
const vec3 HORIZON = vec3(0.95, 1.08, 1.2);
float hash(vec2 p) { return fract(sin(dot(p, vec2(127.1, 311.7))) * 43758.5453); }
float wisps(vec2 p) {
    vec2 i = floor(p), f = fract(p);
    f = f * f * (3.0 - 2.0 * f);
    return mix(mix(hash(i), hash(i + vec2(1, 0)), f.x), mix(hash(i + vec2(0, 1)), hash(i + vec2(1, 1)), f.x), f.y);
}
vec3 sky(vec3 ray) {
    float up = clamp(ray.z, 0.0, 1.0);
    vec3 blue = mix(HORIZON, vec3(0.20, 0.42, 0.85), pow(up, 0.42));
    return blue + vec3(0.20, 0.17, 0.12) * pow(max(dot(ray, sun), 0.0), 12.0);
}
vec3 developed(vec3 light) {
    light *= 0.36 * brightness;
    vec3 c = light * (2.51 * light + 0.03) / (light * (2.43 * light + 0.59) + 0.14);
    return sqrt(clamp(c, 0.0, 1.0));
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
uniform sampler2DShadow shade;
uniform mat4 shade_site;
uniform vec3 eye_m;
in vec3 at; in vec3 facing; in vec2 place; in vec3 tint;
out vec4 pixel;
"""
    + _SKY
    + """
const float HAZE_M = 1900.0;
const vec3 AIR = vec3(0.84, 1.02, 1.24);
const vec3 SUNLIGHT = vec3(2.05, 1.90, 1.62);

// Up to three samples along the longer axis of the pixel's print on the texture: the driver's own way is fifty times slower.
vec3 painted() {
    vec2 dx = dFdx(place), dy = dFdy(place);
    bool wide = dot(dx, dx) > dot(dy, dy);
    vec2 longer = wide ? dx : dy, shorter = wide ? dy : dx;
    vec3 sum;
    if (dot(longer, longer) < 4.0 * dot(shorter, shorter)) sum = textureGrad(surface, place, dx * 0.8, dy * 0.8).rgb;
    else {
        vec2 step = longer * 0.36;
        sum = vec3(0.0);
        for (int i = 0; i < 3; i++)
            sum += textureGrad(surface, place + longer * (float(i) * 0.333 - 0.333), step, shorter).rgb;
        sum *= 1.0 / 3.0;
    }
    return sum * sum;
}
float sunlit(vec3 n) {
    vec3 p = (shade_site * vec4(at + n * 0.12, 1.0)).xyz * 0.5 + 0.5;
    if (any(lessThan(p, vec3(0.0))) || any(greaterThan(p, vec3(1.0)))) return 1.0;
    float texel = 0.4 / float(textureSize(shade, 0).x);
    return 0.5 * (texture(shade, p + vec3(-texel, texel, 0.0)) + texture(shade, p + vec3(texel, -texel, 0.0)));
}
void main() {
    vec3 away = at - eye_m;
    float far_m = length(away);
    vec3 n = normalize(facing);
    if (dot(n, away) > 0.0) n = -n;
    float falls = max(dot(n, sun), 0.0);
    if (falls > 0.0) falls *= sunlit(n);
    vec3 ambient = mix(vec3(0.46, 0.41, 0.34), vec3(0.46, 0.52, 0.62), 0.5 + 0.5 * n.z);
    vec3 lit = painted() * tint * (ambient + SUNLIGHT * falls);
    pixel = vec4(developed(mix(lit, AIR, 1.0 - exp(-far_m / HAZE_M))), 1.0);
}
"""
)
SHADE_VERTEX = """
#version 330
uniform mat4 shade_site;
in vec3 position;
void main() { gl_Position = shade_site * vec4(position, 1.0); }
"""
SHADE_FRAGMENT = """
#version 330
void main() {}
"""
SKY_VERTEX = """
#version 330
uniform vec2 scale; uniform vec2 centre;
out vec2 ray;
void main() {
    vec2 corner = vec2(gl_VertexID & 1, gl_VertexID >> 1);
    ray = (corner - centre) * scale;
    gl_Position = vec4(corner * 2.0 - 1.0, 0.999999, 1.0);
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
void main() {
    vec3 r = normalize(R_site_cam * vec3(ray, 1.0));
    vec2 p = r.xy / max(r.z + 0.12, 0.05) * vec2(1.1, 2.6);
    float veil = 0.6 * wisps(p) + 0.4 * wisps(p * 3.1 + 7.0);
    float cloud = smoothstep(0.55, 0.95, veil) * 0.45 * smoothstep(0.0, 0.25, r.z);
    pixel = vec4(developed(mix(sky(r), vec3(1.3), cloud)), 1.0);
}
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
