/** What a page reads of a site: leniently, and in the visitor's language. */

import { parseSite } from "../../web/src/site";

const NAMES = { en: "Temple", tr: "Tapınak" };
const SITE = {
  name: "State Agora of Ephesus",
  models: { roman: { levels: ["/models/roman.0.glb", 3, "/models/roman.1.glb"] }, own: "/models/own.glb", broken: 3 },
  attribution: "© OpenStreetMap contributors, ODbL 1.0",
  default_view: { id: "square", names: NAMES, e_m: 1, n_m: 2, heading_rad: 3, pitch_rad: 0.1 },
  tour: [{ id: "temple", name: "The temple", text: { en: "Look up." } }, null],
  sources: { FiE: "Forschungen in Ephesos", broken: 3 },
  evidence: { inferred: { en: "Inferred: so it was", tr: "Çıkarım" }, attested: 3 },
  monuments: [
    {
      id: "temple",
      name: "t",
      names: NAMES,
      evidence: "inferred",
      sources: ["FiE", "own", 3],
      captions: { en: "A caption." },
      caption_status: "unreviewed",
      variants: [{ id: "a", name: NAMES, why: { en: "Because." } }, { id: "b" }, 3],
      default_variant: "a",
      footprint_en: [[1, 2], [3, "4"], [5, 6, 7], 8],
      base_z_m: -0.5,
      height_m: 13,
    },
    { id: "bare" },
    "none",
  ],
  landmarks: [
    { id: "corner", names: NAMES, point_site_m: [1, 2, 3] },
    { id: "flat", point_site_m: [1, 2] },
    { point_site_m: [1, 2, 3] },
    { id: "nowhere" },
    4,
  ],
  walkable: "/models/walkable.glb",
};

test("a site is read with its monuments, and what it leaves out has a plain value", () => {
  const site = parseSite(SITE);
  expect(site.models).toEqual({ roman: ["/models/roman.0.glb", "/models/roman.1.glb"], own: ["/models/own.glb"] });
  expect(site.attribution).toContain("OpenStreetMap");
  expect(site.evidence).toEqual({ inferred: "Inferred: so it was" });
  expect(site.monuments).toEqual([
    {
      id: "temple",
      name: "Temple",
      evidence: "inferred",
      sources: ["Forschungen in Ephesos", "own"],
      caption: "A caption.",
      isReviewed: false,
      variants: [
        { id: "a", name: "Temple", why: "Because." },
        { id: "b", name: "b", why: null },
      ],
      defaultVariant: "a",
      footprint: [
        [1, 2],
        [5, 6],
      ],
      base_m: -0.5,
      height_m: 13,
    },
    {
      id: "bare",
      name: "bare",
      evidence: null,
      sources: [],
      caption: null,
      isReviewed: true,
      variants: [],
      defaultVariant: null,
      footprint: [],
      base_m: 0,
      height_m: 0,
    },
  ]);
  expect(site.landmarks).toEqual([{ id: "corner", name: "Temple", point_site_m: [1, 2, 3] }]);
  expect(site.walkable).toBe("/models/walkable.glb");
  expect(parseSite({}).walkable).toBeNull();
  const bare = parseSite({});
  expect([bare.models, bare.views, bare.monuments, bare.evidence]).toEqual([{}, [], [], {}]);
});

test("the views are the default one and the tour", () => {
  const [first, second, ...rest] = parseSite(SITE).views;
  expect(first).toEqual({ id: "square", name: "Temple", e_m: 1, n_m: 2, heading_rad: 3, pitch_rad: 0.1, text: null });
  expect(second).toMatchObject({ id: "temple", name: "The temple", text: "Look up.", e_m: 0, heading_rad: 0 });
  expect(rest).toEqual([]);
});

test("texts come in the visitor's language where the site has it, else in English", () => {
  const turkish = parseSite(SITE, ["tr-TR", "de"]);
  expect(turkish.views[0]?.name).toBe("Tapınak");
  expect(turkish.monuments[0]).toMatchObject({ name: "Tapınak", caption: "A caption." });
  expect(turkish.evidence).toEqual({ inferred: "Çıkarım" });
  expect(parseSite(SITE, ["de"]).monuments[0]?.name).toBe("Temple");
});

test("what is no object is no site", () => {
  for (const value of [null, [], 3, "site"]) expect(() => parseSite(value)).toThrow("the site is no JSON object");
});
