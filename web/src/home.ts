/** The start page: the square as it stood, to turn about, and the walks that can be joined. */

import { ACESFilmicToneMapping, Color, Fog, PerspectiveCamera, Raycaster, Vector2, WebGLRenderer } from "three";
import { OrbitControls } from "three/addons/controls/OrbitControls.js";
import { canDraw, element, publishNothing, tell } from "./dom";
import { loadSquare } from "./model";
import { clockText } from "./playback";
import { type Monument, parseSessions, parseSite, type Site } from "./protocol";
import { MODEL_FAILED } from "./words";

const SKY = 0xbfd4e6;
const LOOK_AGAIN_MS = 3000;
/** From over the south-east corner, along the square; gltf axes, metres. */
const VIEW_FROM = [78, 66, 112] as const;
const VIEW_OF = [-25, 2, 0] as const;
/** On a screen held upright the field of view grows upwards, so that at least this much is seen across. */
const LEAST_WIDTH_DEG = 38;

async function showWalks(): Promise<void> {
  const note = element("walks-note", HTMLElement);
  try {
    const sessions = parseSessions(await (await fetch("/api/sessions")).json());
    const links = sessions.map((session) => {
      const link = document.createElement("a");
      link.href =
        session.kind === "replay"
          ? `/replay/${encodeURIComponent(session.name)}`
          : `/ar?session=${encodeURIComponent(session.name)}`;
      const detail = document.createElement("span");
      detail.textContent = session.kind === "replay" ? clockText(session.duration_s) : "live";
      link.append(session.kind === "replay" ? `Replay ${session.log ?? session.name}` : `Join ${session.name}`, detail);
      return link;
    });
    const walks = element("walks", HTMLElement);
    // a list that has not changed stays, and so does the focus on one of its links
    if (links.map((link) => link.outerHTML).join("") !== walks.innerHTML) walks.replaceChildren(...links);
    tell(note, links.length > 0 ? null : "No walk is being shown just now: it appears here when one begins.");
  } catch {
    tell(note, "The server does not answer: trying again …");
  }
  window.setTimeout(() => void showWalks(), LOOK_AGAIN_MS);
}

async function showSquare(site: Site): Promise<void> {
  const canvas = element("view", HTMLCanvasElement);
  const renderer = new WebGLRenderer({ canvas, antialias: true });
  renderer.toneMapping = ACESFilmicToneMapping;
  renderer.shadowMap.enabled = true;
  renderer.shadowMap.autoUpdate = false;
  renderer.shadowMap.needsUpdate = true;
  const { scene, model } = await loadSquare(site.models["roman"] ?? "/models/roman.glb", 1);
  scene.background = new Color(SKY);
  scene.fog = new Fog(SKY, 180, 620);
  const camera = new PerspectiveCamera(45, 1, 0.5, 1500);
  camera.position.set(...VIEW_FROM);
  const controls = new OrbitControls(camera, canvas);
  controls.target.set(...VIEW_OF);
  controls.maxPolarAngle = 1.5;
  controls.minDistance = 8;
  controls.maxDistance = 320;
  controls.enableDamping = false;
  controls.listenToKeyEvents(canvas);
  let asked = false;
  const draw = (): void => {
    asked = false;
    renderer.render(scene, camera);
  };
  const ask = (): void => {
    if (!asked) requestAnimationFrame(draw);
    asked = true;
  };
  controls.addEventListener("change", ask);
  const fill = (): void => {
    renderer.setPixelRatio(Math.min(window.devicePixelRatio, 2));
    renderer.setSize(canvas.clientWidth, canvas.clientHeight, false);
    camera.aspect = canvas.clientWidth / Math.max(1, canvas.clientHeight);
    camera.fov = fieldOf(camera.aspect);
    camera.updateProjectionMatrix();
    ask();
  };
  new ResizeObserver(fill).observe(canvas);
  controls.update();
  fill();
  nameOnHover(canvas, camera, model, site.monuments);
}

/** Return the vertical field of view, degrees, that shows the width of the square on a screen of this shape. */
function fieldOf(aspect: number): number {
  const halfWidth = Math.tan((LEAST_WIDTH_DEG * Math.PI) / 360);
  return Math.max(45, (Math.atan(halfWidth / aspect) * 360) / Math.PI);
}

/** Name the monument under the pointer, or under a finger that taps. */
function nameOnHover(
  canvas: HTMLCanvasElement,
  camera: PerspectiveCamera,
  model: Parameters<Raycaster["intersectObject"]>[0],
  monuments: readonly Monument[],
): void {
  const label = element("label", HTMLElement);
  const caster = new Raycaster();
  const byId = new Map(monuments.map((monument) => [monument.id, monument]));
  let busy = false;
  const nameAt = ({ clientX, clientY }: MouseEvent): void => {
    if (busy) return;
    busy = true;
    requestAnimationFrame(() => {
      busy = false;
      caster.setFromCamera(new Vector2((2 * clientX) / innerWidth - 1, 1 - (2 * clientY) / innerHeight), camera);
      let node = caster.intersectObject(model)[0]?.object ?? null;
      while (node !== null && !byId.has(node.name)) node = node.parent;
      const monument = node === null ? undefined : byId.get(node.name);
      tell(label, monument?.name ?? null);
      label.style.left = `${clientX}px`;
      label.style.top = `${clientY}px`;
    });
  };
  canvas.onpointermove = (event) => {
    if (event.buttons === 0) nameAt(event);
    else tell(label, null);
  };
  canvas.onclick = nameAt;
  canvas.onpointerleave = ({ pointerType }) => {
    if (pointerType === "mouse") tell(label, null);
  };
}

async function start(): Promise<void> {
  const notice = element("notice", HTMLElement);
  void showWalks();
  if (!canDraw(notice)) return;
  try {
    const site = parseSite(await (await fetch("/api/site")).json());
    element("site", HTMLElement).textContent = site.name;
    element("credit", HTMLElement).textContent = site.attribution;
    await showSquare(site);
  } catch (error) {
    tell(notice, MODEL_FAILED);
    console.warn(error);
  }
}

publishNothing(start());
