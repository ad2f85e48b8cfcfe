/** What `GET /api/site` tells: the facts of a site, read leniently, every text in the visitor's language. No DOM in here. */

import type { Vector3 } from "./frames";
import { say } from "./language/speech";
import type { Place } from "./plan";
import { type Fields, fields, list, number, text_, texts } from "./protocol";

/** One of several ways in which scholars rebuild a monument. */
export interface Variant {
  readonly id: string;
  readonly name: string;
  /** What speaks for it. */
  readonly why: string | null;
}

export interface Monument {
  readonly id: string;
  readonly name: string;
  readonly evidence: string | null;
  /** Where that is from, in full. */
  readonly sources: readonly string[];
  readonly caption: string | null;
  readonly isReviewed: boolean;
  readonly variants: readonly Variant[];
  readonly defaultVariant: string | null;
  /** Corners on the ground, east and north. */
  readonly footprint: readonly Place[];
  /** Of its foot, over the site's origin. */
  readonly base_m: number;
  readonly height_m: number;
}

/** A point that stands today and that visitors can find again: they point it out to say where the picture looks. */
export interface Landmark {
  readonly id: string;
  readonly name: string;
  readonly point_site_m: Vector3;
}

/** A place to stand and a direction to look in. */
export interface View {
  readonly id: string;
  readonly name: string;
  readonly e_m: number;
  readonly n_m: number;
  /** Clockwise from north. */
  readonly heading_rad: number;
  readonly pitch_rad: number;
  /** What a guide says there. */
  readonly text: string | null;
}

export interface Origin {
  readonly lat_deg: number;
  readonly lon_deg: number;
}

export interface Site {
  readonly name: string;
  /** Addresses of each model's levels of detail, the finest first. */
  readonly models: Readonly<Record<string, readonly string[]>>;
  readonly attribution: string;
  readonly eye_height_m: number;
  /** The default view, then the guided tour. */
  readonly views: readonly View[];
  /** What each level of evidence means, in words. */
  readonly evidence: Readonly<Record<string, string>>;
  /** What the keys of sources stand for. */
  readonly sources: Readonly<Record<string, string>>;
  readonly monuments: readonly Monument[];
  readonly landmarks: readonly Landmark[];
  /** Address of what visitors walk on; null where it is not built. */
  readonly walkable: string | null;
  /** Address of what hides the model today; null where it is not built. */
  readonly occluders: string | null;
  /** Where the site's frame is on the Earth; null for nobody knows. */
  readonly origin: Origin | null;
}

/** Read a site; texts in the first of `languages` that it has, else in English. */
export function parseSite(value: unknown, languages: readonly string[] = []): Site {
  const site = fields(value, "site");
  const views = [site["default_view"], ...list(site["tour"])].filter(isObject);
  const sources = texts(site["sources"]);
  return {
    name: inLanguage(site["names"], languages) ?? text_(site["name"], say("site")),
    models: parseModels(site["models"]),
    attribution: text_(site["attribution"], ""),
    eye_height_m: number(site["eye_height_m"], 1.65),
    views: views.map((view) => parseView(view, languages)),
    evidence: parseTexts(site["evidence"], languages),
    sources,
    monuments: list(site["monuments"])
      .filter(isObject)
      .map((monument) => parseMonument(monument, languages, sources)),
    landmarks: list(site["landmarks"])
      .filter(isObject)
      .flatMap((landmark) => parseLandmark(landmark, languages)),
    walkable: typeof site["walkable"] === "string" ? site["walkable"] : null,
    occluders: typeof site["occluders"] === "string" ? site["occluders"] : null,
    origin: parseOrigin(site["origin"]),
  };
}

function parseOrigin(value: unknown): Origin | null {
  const origin = isObject(value) ? value : {};
  const [lat_deg, lon_deg] = [number(origin["lat_deg"], Number.NaN), number(origin["lon_deg"], Number.NaN)];
  return Math.abs(lat_deg) <= 90 && Math.abs(lon_deg) <= 360 ? { lat_deg, lon_deg } : null;
}

/** A model is the address of its only file, or its levels. */
function parseModels(value: unknown): Site["models"] {
  const models = Object.entries(isObject(value) ? value : {}).map(([name, model]): [string, readonly string[]] => {
    if (typeof model === "string") return [name, [model]];
    return [name, list(isObject(model) ? model["levels"] : []).filter((url) => typeof url === "string")];
  });
  return Object.fromEntries(models.filter(([, levels]) => levels.length > 0));
}

function parseView(view: Fields, languages: readonly string[]): View {
  return {
    id: text_(view["id"], ""),
    name: inLanguage(view["names"] ?? view["name"], languages) ?? text_(view["id"], "unnamed"),
    e_m: number(view["e_m"], 0),
    n_m: number(view["n_m"], 0),
    heading_rad: number(view["heading_rad"], 0),
    pitch_rad: number(view["pitch_rad"], 0),
    text: inLanguage(view["texts"] ?? view["text"], languages),
  };
}

function parseMonument(monument: Fields, languages: readonly string[], sources: Site["sources"]): Monument {
  const keys = list(monument["sources"]).filter((key) => typeof key === "string");
  return {
    id: text_(monument["id"], ""),
    name: inLanguage(monument["names"] ?? monument["name"], languages) ?? text_(monument["id"], "unnamed"),
    evidence: typeof monument["evidence"] === "string" ? monument["evidence"] : null,
    sources: keys.map((key) => sources[key] ?? key),
    caption: inLanguage(monument["captions"] ?? monument["caption"], languages),
    isReviewed: monument["caption_status"] !== "unreviewed",
    variants: list(monument["variants"])
      .filter(isObject)
      .map((variant) => parseVariant(variant, languages)),
    defaultVariant: typeof monument["default_variant"] === "string" ? monument["default_variant"] : null,
    footprint: list(monument["footprint_en"]).flatMap((corner): Place[] => {
      const [e, n] = list(corner).map((value) => number(value, Number.NaN));
      return e !== undefined && n !== undefined && Number.isFinite(e + n) ? [[e, n]] : [];
    }),
    base_m: number(monument["base_z_m"], 0),
    height_m: number(monument["height_m"], 0),
  };
}

/** A landmark without a place is none. */
function parseLandmark(landmark: Fields, languages: readonly string[]): Landmark[] {
  const id = text_(landmark["id"], "");
  const [e, n, u] = list(landmark["point_site_m"]).map((value) => number(value, Number.NaN));
  if (id === "" || e === undefined || n === undefined || u === undefined || !Number.isFinite(e + n + u)) return [];
  return [{ id, name: inLanguage(landmark["names"] ?? landmark["name"], languages) ?? id, point_site_m: [e, n, u] }];
}

function parseVariant(variant: Fields, languages: readonly string[]): Variant {
  const id = text_(variant["id"], "");
  return {
    id,
    name: inLanguage(variant["names"] ?? variant["name"], languages) ?? id,
    why: inLanguage(variant["why"], languages),
  };
}

function parseTexts(value: unknown, languages: readonly string[]): Readonly<Record<string, string>> {
  const entries = Object.entries(isObject(value) ? value : {}).flatMap(([key, text]): [string, string][] => {
    const words = inLanguage(text, languages);
    return words === null ? [] : [[key, words]];
  });
  return Object.fromEntries(entries);
}

/** Return a text, or that one of several by language which is understood best; null for none. */
function inLanguage(value: unknown, languages: readonly string[]): string | null {
  if (typeof value === "string") return value === "" ? null : value;
  const known = texts(value);
  const best = [...languages.map((language) => language.slice(0, 2)), "en"].find((language) => known[language]);
  return best === undefined ? (Object.values(known)[0] ?? null) : (known[best] ?? null);
}

function isObject(value: unknown): value is Fields {
  return typeof value === "object" && value !== null && !Array.isArray(value);
}
