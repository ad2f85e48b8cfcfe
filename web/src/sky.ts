/** Where the sun stands when nobody says, and the sky about the square. three.js only. */

import { BackSide, Color, Mesh, ShaderMaterial, SphereGeometry, Vector3 } from "three";
import { T_gltf_site, transform } from "./frames";
import { directionOf, type Sun } from "./sun";

/** Towards the sun, gltf axes: an hour after noon in early summer, as in the simulator's pictures (`assets/render.py`). */
export const TO_SUN = new Vector3(-0.249, 0.883, 0.398).normalize();
const RADIUS_M = 1200;

/** The colours of the sky by the sun's height, degrees: at the horizon, overhead, and of the air about the sun. */
const HOURS: readonly (readonly [number, string, string, string])[] = [
  [-12, "#141b2e", "#060a16", "#1a2036"],
  [-4, "#6d6276", "#1f2f55", "#e0785a"],
  [1, "#e0b58e", "#45679b", "#ffb070"],
  [8, "#e3d3bd", "#5a88bf", "#ffd9a0"],
  [25, "#cddae4", "#5f93cc", "#fff3da"],
  [90, "#cddae4", "#5f93cc", "#fff3da"],
];

const VERTEX = /* glsl */ `
  varying vec3 vTowards;
  void main() {
    vTowards = position;
    gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0);
  }`;

const FRAGMENT = /* glsl */ `
  uniform vec3 horizon; uniform vec3 zenith; uniform vec3 glow; uniform vec3 toSun;
  varying vec3 vTowards;
  void main() {
    vec3 towards = normalize(vTowards);
    vec3 colour = mix(horizon, zenith, pow(clamp(towards.y, 0.0, 1.0), 0.55));
    float near = max(dot(towards, toSun), 0.0);
    float low = 1.0 - smoothstep(0.0, 0.35, toSun.y);
    colour += glow * (pow(near, 60.0) * 0.6 + low * pow(near, 6.0) * 0.35 * smoothstep(-0.15, 0.05, toSun.y));
    gl_FragColor = linearToOutputTexel(vec4(colour, 1.0));
  }`;

export class Sky {
  readonly mesh: Mesh<SphereGeometry, ShaderMaterial>;
  /** What lies far away takes this colour. */
  readonly horizon = new Color();
  private readonly zenith = new Color();
  private readonly glow = new Color();
  private readonly toSun = TO_SUN.clone();

  constructor() {
    const material = new ShaderMaterial({
      uniforms: {
        horizon: { value: this.horizon },
        zenith: { value: this.zenith },
        glow: { value: this.glow },
        toSun: { value: this.toSun },
      },
      vertexShader: VERTEX,
      fragmentShader: FRAGMENT,
      side: BackSide,
      depthWrite: false,
      fog: false,
      toneMapped: false,
    });
    this.mesh = new Mesh(new SphereGeometry(RADIUS_M, 32, 16), material);
    this.mesh.renderOrder = -1;
    this.colour((Math.asin(TO_SUN.y) * 180) / Math.PI);
  }

  /** Show the sky under a sun at this place. */
  shine(sun: Sun): void {
    this.toSun.set(...transform(T_gltf_site, directionOf(sun)));
    this.colour((sun.elevation_rad * 180) / Math.PI);
  }

  dispose(): void {
    this.mesh.geometry.dispose();
    this.mesh.material.dispose();
  }

  private colour(height_deg: number): void {
    const after = Math.max(
      1,
      HOURS.findIndex(([height]) => height >= height_deg),
    );
    const [low, high] = [HOURS[after - 1], HOURS[after]];
    if (!low || !high) return;
    const way = Math.min(1, Math.max(0, (height_deg - low[0]) / (high[0] - low[0])));
    [this.horizon, this.zenith, this.glow].forEach((colour, i) => {
      colour.set(low[i + 1] as string).lerp(new Color(high[i + 1] as string), way);
    });
  }
}
