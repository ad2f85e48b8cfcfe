/** A walker's poses as shown: at the told places, smoothly, not far in the past, and never backwards in time. */

import { angleBetween, length, minus } from "../../web/src/beside/between";
import { Poses, type Shown } from "../../web/src/beside/poses";
import type { PoseMessage } from "../../web/src/wire";
import { forSeeds, type Random } from "./random";

const START_NS = 1.7e18;
/** Of a browser's clock that has nothing to do with the rig's. */
const NOW_MS = 5e6;
const PICTURE_MS = 1000 / 60;

interface Message {
  readonly pose: PoseMessage;
  readonly arrived_ms: number;
}

/** A walker on a circle of 5 m at 1.4 m/s, head turning with the way. */
function walked(t_s: number): PoseMessage {
  const angle_rad = (1.4 / 5) * t_s;
  return {
    seq: 0,
    t_ns: START_NS + t_s * 1e9,
    p_site_body_m: [5 * Math.cos(angle_rad), 5 * Math.sin(angle_rad), 1.7],
    wxyz_site_body: [Math.cos(angle_rad / 2), 0, 0, Math.sin(angle_rad / 2)],
    variance: [0, 0, 0, 0, 0, 0],
    v_site_m_s: [-1.4 * Math.sin(angle_rad), 1.4 * Math.cos(angle_rad), 0],
    headingKnown: true,
    isTruth: false,
    soughtJustBefore: false,
    motionModel: "P1R1",
  };
}

/** Messages of `seconds`, each up to `unrest_ms` late. */
function walk(random: Random, hz: number, seconds: number, unrest_ms: number): Message[] {
  const count = Math.floor(seconds * hz);
  const messages = Array.from({ length: count }, (_, i) => ({
    pose: walked(i / hz),
    arrived_ms: NOW_MS + (1000 * i) / hz + random.between(0, unrest_ms),
  }));
  return messages.sort((a, b) => a.arrived_ms - b.arrived_ms);
}

/** Play messages as a page does: those that have come are taken before each picture. */
function play(messages: readonly Message[], until_ms: number, poses = new Poses()): (Shown & { now_ms: number })[] {
  const shown: (Shown & { now_ms: number })[] = [];
  let next = 0;
  for (let now_ms = NOW_MS; now_ms < NOW_MS + until_ms; now_ms += PICTURE_MS) {
    for (let message = messages[next]; message && message.arrived_ms <= now_ms; message = messages[++next])
      poses.take(message.pose, message.arrived_ms);
    const place = poses.at(now_ms);
    if (place !== null) shown.push({ ...place, now_ms });
  }
  return shown;
}

const t_s = (shown: Shown): number => (shown.t_ns - START_NS) * 1e-9;

test("before the first pose there is nobody", () => {
  expect(new Poses().at(NOW_MS)).toBeNull();
});

test("thirty poses a second are shown within millimetres, not far in the past", () => {
  forSeeds(20, (random) => {
    const shown = play(walk(random, 30, 5, 10), 5000).slice(60);
    for (const one of shown) {
      expect(length(minus(one.p_site_body_m, walked(t_s(one)).p_site_body_m))).toBeLessThan(0.005);
      expect(angleBetween(one.wxyz_site_body, walked(t_s(one)).wxyz_site_body)).toBeLessThan(0.01);
      expect(one.age_ms).toBeLessThan(70);
    }
  });
});

test("whatever the rate and the unrest, the age keeps to its limit and the place to the walk", () => {
  forSeeds(20, (random) => {
    const hz = random.between(10, 60);
    const shown = play(walk(random, hz, 8, 40), 7900).slice(120);
    const ages = shown.map(({ age_ms }) => age_ms).sort((a, b) => a - b);
    expect(ages[Math.floor(0.95 * ages.length)]).toBeLessThan(100);
    for (const one of shown) {
      const now_s = (one.now_ms - NOW_MS) / 1000;
      expect(length(minus(one.p_site_body_m, walked(now_s).p_site_body_m))).toBeLessThan(1.4 * 0.2);
    }
  });
});

test("the moment shown never goes back, and the walker never jumps", () => {
  forSeeds(30, (random) => {
    const messages = walk(random, 25, 6, 60).filter(() => random.below(8) > 0);
    const shown = play(messages, 6000);
    shown.slice(1).forEach((one, i) => {
      const before = shown[i] ?? one;
      expect(one.t_ns).toBeGreaterThanOrEqual(before.t_ns);
      // 1.4 m/s, half as fast again while catching up, and up to 0.2 s of way that fades within 80 ms
      const most_m_s = 1.4 * (1.5 + 0.2 / 0.08);
      expect(length(minus(one.p_site_body_m, before.p_site_body_m))).toBeLessThan((most_m_s * PICTURE_MS) / 1000);
    });
  });
});

test("a walker who has gone silent stands where it was told last, and goes on without a jump", () => {
  forSeeds(10, (random) => {
    const all = walk(random, 30, 8, 10);
    const isSilent = ({ pose }: Message): boolean => pose.t_ns > START_NS + 2e9 && pose.t_ns < START_NS + 2.8e9;
    const shown = play(
      all.filter((message) => !isSilent(message)),
      8000,
    );
    const last = all.filter((message) => message.pose.t_ns <= START_NS + 2e9).at(-1);
    const standing = shown.filter(({ now_ms }) => now_ms > NOW_MS + 2400 && now_ms < NOW_MS + 2800);
    expect(standing.length).toBeGreaterThan(20);
    for (const one of standing) {
      expect(length(minus(one.p_site_body_m, last?.pose.p_site_body_m ?? [0, 0, 0]))).toBeLessThan(0.01);
      expect(one.age_ms).toBeGreaterThan(200);
    }
    const end = shown.at(-1);
    expect(end && length(minus(end.p_site_body_m, walked(t_s(end)).p_site_body_m))).toBeLessThan(0.005);
    expect(end?.age_ms).toBeLessThan(100);
  });
});

test("a pose that comes late is met within some pictures, without a step back along the way", () => {
  forSeeds(30, (random) => {
    const messages = walk(random, 30, 4, 5).map((message, i) =>
      i % 20 === 19 ? { ...message, arrived_ms: message.arrived_ms + 60 } : message,
    );
    const inOrder = [...messages].sort((a, b) => a.arrived_ms - b.arrived_ms);
    const shown = play(inOrder, 4000).slice(30);
    shown.slice(1).forEach((one, i) => {
      const before = shown[i] ?? one;
      const [ve, vn] = walked(t_s(one)).v_site_m_s;
      const [e, n] = minus(one.p_site_body_m, before.p_site_body_m);
      expect(e * ve + n * vn).toBeGreaterThan(-0.002);
    });
  });
});

test("a seek, a loop, another rig and a jump in place begin anew, at once", () => {
  const elsewhere: readonly ((pose: PoseMessage) => PoseMessage)[] = [
    (pose) => ({ ...pose, soughtJustBefore: true, p_site_body_m: [9, 9, 1.7] }),
    (pose) => ({ ...pose, t_ns: START_NS - 60e9, p_site_body_m: [9, 9, 1.7] }),
    (pose) => ({ ...pose, t_ns: pose.t_ns + 60e9, p_site_body_m: [9, 9, 1.7] }),
    (pose) => ({ ...pose, p_site_body_m: [90, 9, 1.7] }),
  ];
  for (const change of elsewhere) {
    const poses = new Poses();
    forSeeds(1, (random) => play(walk(random, 30, 1, 5), 1000, poses));
    const pose = change(walked(1.03));
    poses.take(pose, NOW_MS + 1030);
    expect(poses.at(NOW_MS + 1040)?.p_site_body_m).toEqual(pose.p_site_body_m);
    expect(poses.at(NOW_MS + 1040)?.t_ns).toBeLessThanOrEqual(pose.t_ns);
  }
});

test("a pose from before the newest says nothing", () => {
  const poses = new Poses();
  poses.take(walked(1), NOW_MS);
  poses.take(walked(0.9), NOW_MS + 5);
  expect(poses.newest?.t_ns).toBe(START_NS + 1e9);
});

test.each([0.25, 2, 4])("a replay at %s times its pace is as smooth and as new", (speed) => {
  const messages = Array.from({ length: Math.floor(100 / speed) }, (_, i) => ({
    pose: walked((i * speed) / 12),
    arrived_ms: NOW_MS + (1000 * i) / 12,
  }));
  const until_ms = (1000 * messages.length) / 12;
  for (const one of play(messages, until_ms, new Poses(speed, 130)).slice(20)) {
    expect(length(minus(one.p_site_body_m, walked(t_s(one)).p_site_body_m))).toBeLessThan(0.02 * speed);
    expect(one.age_ms).toBeLessThan(150);
  }
});
