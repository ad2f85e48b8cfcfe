/** Where the sun stands, and the sky about the square. three.js only. */

import { BackSide, Color, Mesh, ShaderMaterial, SphereGeometry, Vector3 } from "three";

/** Towards the sun, gltf axes: an hour after noon in early summer, as in the simulator's pictures (`assets/render.py`). */
export const TO_SUN = new Vector3(-0.249, 0.883, 0.398).normalize();
export const HORIZON = new Color(0xcddae4);
const ZENITH = new Color(0x5f93cc);
const RADIUS_M = 1200;

const VERTEX = /* glsl */ `
  varying vec3 vTowards;
  void main() {
    vTowards = position;
    gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0);
  }`;

const FRAGMENT = /* glsl */ `
  uniform vec3 horizon; uniform vec3 zenith; uniform vec3 toSun;
  varying vec3 vTowards;
  void main() {
    vec3 towards = normalize(vTowards);
    vec3 colour = mix(horizon, zenith, pow(clamp(towards.y, 0.0, 1.0), 0.55));
    colour += vec3(1.0, 0.9, 0.7) * pow(max(dot(towards, toSun), 0.0), 60.0) * 0.6;
    gl_FragColor = linearToOutputTexel(vec4(colour, 1.0));
  }`;

/** Return a sky for the scene of the start page; the camera picture has one of its own. */
export function makeSky(): Mesh {
  const material = new ShaderMaterial({
    uniforms: { horizon: { value: HORIZON }, zenith: { value: ZENITH }, toSun: { value: TO_SUN } },
    vertexShader: VERTEX,
    fragmentShader: FRAGMENT,
    side: BackSide,
    depthWrite: false,
    fog: false,
    toneMapped: false,
  });
  const sky = new Mesh(new SphereGeometry(RADIUS_M, 32, 16), material);
  sky.renderOrder = -1;
  return sky;
}
