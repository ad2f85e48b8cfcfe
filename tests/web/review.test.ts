import { joined, tableOf } from "../../web/src/replay/curves";
import { happeningsAt, modelAt, parseCourse, parseTimeline } from "../../web/src/replay/review";
import { happeningWords, spanWords } from "../../web/src/replay/told";

const COURSE = parseCourse({
  estimator: "gps-imu/famm",
  t_s: [0, 1, 2],
  heading_deg: [null, 10, 20],
  sigma_m: [3, 2, 1],
  sigma_heading_deg: [9, 8, 7],
  error_m: [null, null, null],
  heading_error_deg: [1, "x", 3],
  innovation_s: [0.5, 1],
  innovation_m: [4, 5],
  innovation_deg: [1, 2],
  models: [
    [0, "P1R1"],
    [1.5, "P2R1"],
    ["bad", 3],
  ],
  figures: { truth: { ate_rmse_m: 1.5, heading_rmse_deg: 2.25, tilt_rmse_deg: null }, filter_error_m: { mean: 0.5 } },
});

describe("a timeline", () => {
  const TIMELINE = parseTimeline({
    duration_s: 90,
    pictures_s: [0, 0.1, "x"],
    has_truth: true,
    events: [
      { kind: "silence", from_s: 10, until_s: 14, sensor: "gps" },
      { kind: "stop", from_s: 12, until_s: 75 },
      { kind: "earthquake", from_s: 1, until_s: 2 },
      { kind: "stop", from_s: null, until_s: 2 },
    ],
  });

  test("leaves out what it does not know", () => {
    expect(TIMELINE.pictures_s).toEqual([0, 0.1]);
    expect(TIMELINE.happenings.map(({ kind }) => kind)).toEqual(["silence", "stop"]);
    expect(() => parseTimeline([])).toThrow("no JSON object");
  });

  test("tells what happens at a place, in words", () => {
    expect(happeningsAt(TIMELINE, 13)).toHaveLength(2);
    expect(happeningsAt(TIMELINE, 9)).toHaveLength(0);
    expect(happeningsAt(TIMELINE, 9, 1)).toHaveLength(1);
    expect(TIMELINE.happenings.map(happeningWords)).toEqual(["GPS: nothing came", "Stood still"]);
    expect(TIMELINE.happenings.map(spanWords)).toEqual(["0:10 to 0:14", "0:12 to 1:15"]);
  });
});

describe("a course", () => {
  test("has gaps where nothing is known, and figures", () => {
    expect(COURSE.heading_error_deg).toEqual([1, null, 3]);
    expect(COURSE.figures).toEqual({ ate_m: 1.5, heading_deg: 2.25, tilt_deg: null, filter_m: 0.5, gps_m: null });
  });

  test("tells the motion model in force", () => {
    expect([-1, 0, 1.4, 1.5, 9].map((t) => modelAt(COURSE, t))).toEqual([null, "P1R1", "P1R1", "P2R1", "P2R1"]);
  });
});

describe("curves", () => {
  test("of different times stand over all of them, and say nothing where they have none", () => {
    expect(
      joined([
        [
          [0, 2],
          [1, null],
        ],
        [
          [1, 2],
          [5, 6],
        ],
      ]),
    ).toEqual([
      [0, 1, 2],
      [1, undefined, null],
      [undefined, 5, 6],
    ]);
  });

  test("are drawn of those who have a value of them", () => {
    const other = { ...COURSE, error_m: [0.5, 0.25, null] };
    const chosen = [
      { course: COURSE, colour: 0 },
      { course: other, colour: 3 },
    ];
    expect(tableOf("error", chosen)).toEqual({
      data: [
        [0, 1, 2],
        [0.5, 0.25, null],
      ],
      colours: [3],
      unit: "m",
      decimals: 2,
    });
    expect(tableOf("error", chosen.slice(0, 1))).toBeNull();
    expect(tableOf("innovation", chosen)?.data).toEqual([
      [0.5, 1],
      [4, 5],
      [4, 5],
    ]);
  });
});
