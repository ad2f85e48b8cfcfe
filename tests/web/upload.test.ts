import { nameOf, otherName, refusalOf } from "../../web/src/replay/upload";

/** As `server/grants.py` has it. */
const ALLOWED = /^[A-Za-z0-9][A-Za-z0-9._-]{0,63}$/;

describe("a recording's name", () => {
  test("is the file's as far as the server allows", () => {
    expect(nameOf("walk-1.mcap")).toBe("walk-1");
    expect(nameOf("Meine Tour, März (2).MCAP")).toBe("Meine-Tour-M-rz-2-");
    expect(nameOf("..\\x.mcap")).toBe("x");
    expect(nameOf("???.mcap")).toBe("walk");
    for (const file of ["ü", "a".repeat(200), ".hidden.mcap", "-", "a/../b.mcap"])
      expect(nameOf(file)).toMatch(ALLOWED);
  });

  test("has a number where it is taken", () => {
    expect(otherName("walk", 2)).toBe("walk-2");
    expect(otherName("a".repeat(64), 12)).toMatch(ALLOWED);
    expect(otherName("a".repeat(64), 12)).toMatch(/-12$/);
  });
});

test("what is refused is told with its remedy", () => {
  expect(refusalOf(403, "")).toContain("/enter");
  expect(refusalOf(405, "Method Not Allowed")).toContain("agora serve");
  expect(refusalOf(413, "A walk may have 5 bytes at most.")).toBe("A walk may have 5 bytes at most.");
  expect(refusalOf(0, "")).toContain("hung up");
  expect(refusalOf(500, "")).not.toBe("");
});
