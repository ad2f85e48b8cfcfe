/** Where the camera is: turned about the square, walked through it, flown, or led by somebody else. three.js's camera and orbit only. */

import { type PerspectiveCamera, Vector3 as Vector } from "three";
import { OrbitControls } from "three/addons/controls/OrbitControls.js";
import { compose, invertRigid, type Matrix4, T_cam_view, T_gltf_site, type Vector3, viewFromCam } from "../frames";
import type { Controls } from "./controls";
import { aheadOf, type Eye, eyeOf, pointAhead, poseOf, tilted, turned } from "./eye";
import { type Flight, flightOf } from "./flight";
import type { Ground } from "./ground";
import { type Intent, isStill } from "./intent";
import { isAtRest, standing, type Walker, walk } from "./walker";
import type { Way } from "./way";
import type { Leader } from "./world";

const TURN_RAD_S = 1.5;
const FLY_M_S = 9;
const HURRIED_FLY_M_S = 32;
/** Who flies stays above the ground and about the site. */
const LOWEST_M = 0.6;
const HIGHEST_M = 220;
const FARTHEST_M = 400;
const ORBIT = { nearest_m: 4, farthest_m: 320, lowest_rad: 1.53, usual_m: 45, back_m: 40, pitch_rad: -0.5 } as const;
const LONGEST_STEP_S = 0.1;

export class Explorer {
  way: Way = "orbit";
  /** What can be walked on; null as long as nobody knows. */
  ground: Ground | null = null;
  /** Called when the way of moving has changed. */
  changed: () => void = () => undefined;
  private readonly orbit: OrbitControls;
  private walker: Walker | null = null;
  private flight: { readonly path: Flight; readonly began_ms: number | null; readonly about_m: number } | null = null;
  private leader: { readonly lead: Leader; readonly released: () => void } | null = null;
  private last_ms: number | null = null;
  private readonly calm = matchMedia("(prefers-reduced-motion: reduce)");

  constructor(
    private readonly camera: PerspectiveCamera,
    canvas: HTMLCanvasElement,
    private readonly controls: Controls,
    private readonly eyeHeight_m: number,
    private readonly ask: () => void,
  ) {
    this.orbit = new OrbitControls(camera, canvas);
    this.orbit.minDistance = ORBIT.nearest_m;
    this.orbit.maxDistance = ORBIT.farthest_m;
    this.orbit.maxPolarAngle = ORBIT.lowest_rad;
    this.orbit.enableDamping = !this.calm.matches;
    this.orbit.dampingFactor = 0.12;
    this.orbit.addEventListener("change", ask);
    controls.woken = ask;
    controls.taken = () => this.stop();
    controls.looked = (turn_rad, tilt_rad) => this.look(turn_rad, tilt_rad);
  }

  get eye(): Eye {
    return eyeOf(this.T_site_cam);
  }

  get T_site_cam(): Matrix4 {
    this.camera.updateMatrixWorld();
    const T_gltf_view = this.camera.matrixWorld.clone().transpose().elements;
    return compose(invertRigid(T_gltf_site), compose(T_gltf_view, T_cam_view));
  }

  /** How far away the point is that is orbited; null where none is. */
  get about_m(): number | null {
    return this.way === "orbit" ? this.orbit.getDistance() : null;
  }

  get isFlying(): boolean {
    return this.flight !== null;
  }

  /** Move in another way from here: down to the ground to walk, up from it to orbit. */
  take(way: Way): void {
    if (way === this.way || (way === "walk" && !this.ground)) return;
    const before = this.way;
    const { eye } = this;
    if (way === "fly") this.settle("fly", ORBIT.usual_m);
    else if (way === "walk") {
      const { x, z } = this.orbit.target;
      const below = before === "orbit" ? ([x, -z] as const) : eye.place_site_m;
      const feet = this.ground?.nearest([below[0], below[1]]);
      if (feet) this.go(this.over(feet, eye.heading_rad), "walk");
    } else {
      const about = pointAhead({ ...eye, pitch_rad: 0 }, ORBIT.usual_m / 3);
      const up = { ...eye, pitch_rad: ORBIT.pitch_rad };
      const place_site_m = pointAhead({ ...up, place_site_m: about }, -ORBIT.back_m);
      this.go({ ...up, place_site_m }, "orbit", ORBIT.back_m);
    }
  }

  /** Fly to a view and move in a way from there; `about_m` is how far ahead the middle of an orbit lies. */
  go(eye: Eye, way: Way, about_m: number = ORBIT.usual_m, isCut = false): void {
    this.release();
    this.orbit.enabled = false;
    this.walker = null;
    this.flight = { path: flightOf(this.eye, eye, isCut || this.calm.matches), began_ms: null, about_m };
    if (way !== this.way) {
      this.way = way;
      this.changed();
    }
    this.ask();
  }

  /** Stand at a place of the plan and look ahead from there; null where the ground is not known. */
  standAt(e_m: number, n_m: number, heading_rad: number): Eye | null {
    const feet = this.ground?.nearest([e_m, n_m]);
    return feet ? this.over(feet, heading_rad) : null;
  }

  lead(leader: Leader | null, released: () => void = () => undefined): void {
    this.release();
    if (!leader) return;
    this.flight = null;
    this.orbit.enabled = false;
    this.leader = { lead: leader, released };
    this.ask();
  }

  /** Take the next step; returns whether another one must follow. */
  turn(now_ms: number): boolean {
    const dt_s = this.last_ms === null ? 0 : Math.min(LONGEST_STEP_S, (now_ms - this.last_ms) / 1000);
    const { intent } = this.controls;
    const wants = !isStill(intent);
    if (wants) this.stop();
    const goesOn = this.step(now_ms, dt_s, intent) || wants;
    // a pause is no step
    this.last_ms = goesOn ? now_ms : null;
    return goesOn || this.controls.mustWatch;
  }

  private step(now_ms: number, dt_s: number, intent: Intent): boolean {
    if (this.leader) {
      const T_site_cam = this.leader.lead(now_ms);
      if (T_site_cam) this.put(T_site_cam);
      return false;
    }
    if (this.flight) return this.fly(now_ms);
    if (this.way === "orbit") return this.circle(intent, dt_s);
    if (isStill(intent) && !this.walker) return false;
    const { eye } = this;
    const turned_ = {
      ...eye,
      heading_rad: turned(eye.heading_rad + intent.turn * TURN_RAD_S * dt_s),
      pitch_rad: tilted(eye.pitch_rad + intent.tilt * TURN_RAD_S * 0.6 * dt_s),
    };
    if (this.way === "fly") return this.drift(turned_, intent, dt_s);
    return this.stride(turned_, intent, dt_s);
  }

  private fly(now_ms: number): boolean {
    const { flight } = this;
    if (!flight) return false;
    const began_ms = flight.began_ms ?? now_ms;
    if (flight.began_ms === null) this.flight = { ...flight, began_ms };
    this.put(poseOf(flight.path.at(now_ms - began_ms)));
    if (now_ms - began_ms < flight.path.duration_ms) return true;
    this.flight = null;
    this.settle(this.way, flight.about_m);
    return false;
  }

  /** Keys turn about the middle, and come nearer. */
  private circle({ ahead, right, up, turn, tilt, hurry }: Intent, dt_s: number): boolean {
    const pace = (hurry ? 2.5 : 1) * dt_s;
    if (ahead !== 0 || right !== 0 || turn !== 0 || up !== 0 || tilt !== 0) {
      const { target } = this.orbit;
      const arm = this.camera.position.clone().sub(target);
      const length = arm.length();
      const flat = Math.atan2(arm.x, arm.z) + (right + turn) * pace;
      const lift = Math.asin(arm.y / length) + (up + tilt) * 0.6 * pace;
      const low = Math.PI / 2 - ORBIT.lowest_rad;
      const lifted = Math.min(1.5, Math.max(low, lift));
      const far = Math.min(ORBIT.farthest_m, Math.max(ORBIT.nearest_m, length * Math.exp(-ahead * pace)));
      const [c, s] = [Math.cos(lifted) * far, Math.sin(lifted) * far];
      this.camera.position.set(target.x + c * Math.sin(flat), target.y + s, target.z + c * Math.cos(flat));
    }
    return this.orbit.update();
  }

  private drift(eye: Eye, intent: Intent, dt_s: number): boolean {
    const [ae, an, au] = aheadOf(eye);
    const [re, rn] = [Math.cos(eye.heading_rad), -Math.sin(eye.heading_rad)];
    const step_m = (intent.hurry ? HURRIED_FLY_M_S : FLY_M_S) * dt_s;
    const [e0, n0, u0] = eye.place_site_m;
    const within = (value: number): number => Math.min(FARTHEST_M, Math.max(-FARTHEST_M, value));
    const e = within(e0 + step_m * (intent.ahead * ae + intent.right * re));
    const n = within(n0 + step_m * (intent.ahead * an + intent.right * rn));
    const floor = (this.ground?.heightAt([e, n], -100, u0 + 1) ?? -100) + LOWEST_M;
    const u = Math.min(HIGHEST_M, Math.max(floor, u0 + step_m * (intent.ahead * au + intent.up)));
    this.put(poseOf({ ...eye, place_site_m: [e, n, u] }));
    return false;
  }

  private stride(eye: Eye, intent: Intent, dt_s: number): boolean {
    const { ground } = this;
    if (!ground) return false;
    const before = this.walker ?? this.stepOff(eye, ground);
    if (!before) return false;
    const walker = walk(before, intent, eye.heading_rad, ground, this.eyeHeight_m, dt_s);
    const [e, n] = walker.feet_site_m;
    this.put(poseOf({ ...eye, place_site_m: [e, n, walker.eyes_m] }));
    const rests = isStill(intent) && isAtRest(walker, this.eyeHeight_m);
    this.walker = rests ? null : walker;
    return !rests;
  }

  /** Somebody who stood where nobody can stand, like at a stop of the tour among benches, steps to the ground beside. */
  private stepOff({ place_site_m: [e, n, u] }: Eye, ground: Ground): Walker | null {
    const z = ground.heightAt([e, n], u - this.eyeHeight_m - 1, u);
    const feet: Vector3 | null = z === null ? ground.nearest([e, n]) : [e, n, z];
    return feet ? { ...standing(feet, this.eyeHeight_m), eyes_m: u } : null;
  }

  /** Turn the head, or do nothing where a drag turns the square. */
  private look(turn_rad: number, tilt_rad: number): void {
    this.release();
    if (this.way === "orbit" || this.flight) return;
    const { eye } = this;
    const heading_rad = turned(eye.heading_rad + turn_rad);
    this.put(poseOf({ ...eye, heading_rad, pitch_rad: tilted(eye.pitch_rad + tilt_rad) }));
    this.ask();
  }

  /** Whoever does something themselves is flown and led no longer; but a flight to where one walks lands first. */
  private stop(): void {
    this.release();
    if (!this.flight || this.way === "walk") return;
    const { about_m } = this.flight;
    this.flight = null;
    this.settle(this.way, about_m);
  }

  private release(): void {
    const { leader } = this;
    this.leader = null;
    if (!leader) return;
    this.settle("fly", ORBIT.usual_m);
    leader.released();
  }

  private settle(way: Way, about_m: number): void {
    this.walker = null;
    this.orbit.enabled = way === "orbit";
    if (way === "orbit") {
      const [e, n, u] = pointAhead(this.eye, about_m);
      this.orbit.target.set(e, u, -n);
      this.orbit.update();
    }
    if (way !== this.way) {
      this.way = way;
      this.changed();
    }
    this.ask();
  }

  private over([e, n, u]: Vector3, heading_rad: number): Eye {
    return { place_site_m: [e, n, u + this.eyeHeight_m], heading_rad, pitch_rad: 0 };
  }

  private put(T_site_cam: Matrix4): void {
    const T = viewFromCam(T_site_cam);
    const { camera } = this;
    camera.matrix.set(...(T as Parameters<typeof camera.matrix.set>));
    camera.matrix.decompose(camera.position, camera.quaternion, new Vector());
  }
}
