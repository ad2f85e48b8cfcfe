"""Where each part of the paper is in the code: what docs/paper.md tabulates, and a test walks.

Equations are counted as arXiv 1512.02766 numbers them, 1 to 12; tables and figures are called by their captions. The photograph of
the rig and the view of the application are no parts of a tracker.
"""

from dataclasses import dataclass


@dataclass(frozen=True)
class Part:
    """One part of the paper."""

    name: str
    where: str
    """`file:symbol`, or a file alone, where the whole of it is meant."""
    cites: str
    """Words by which the docstring there names the part: the symbol's own for an equation, else its own or its file's."""
    test: str
    """Id of a test that fails when the part is wrong."""


_FUZZY = "tests/tracker/test_fuzzy.py::"
_FUSION = "tests/tracker/test_fusion.py::"
_ALL_RULES = f"{_FUZZY}test_one_query_equals_the_strongest_of_81_rules"
_SIX_PAIRS = f"{_FUSION}test_six_pairs_equal_twelve_states"
_GEODESY = "tests/tracker/test_geodesy.py::"
_CALIBRATION = "tests/tracker/test_calibration.py::"
_RUNS = "tests/server/plots/test_runs.py::"

SENSORS = (
    Part(
        "Eq. 1: Tr from three Euler angles, R = Rx Ry Rz, and a translation",
        "tracker/transformation.py:tr_from_euler",
        "eq. 1",
        "tests/tracker/test_transformation.py::test_the_printed_matrix_is_rx_ry_rz",
    ),
    Part(
        "Tr of the two most recent keyframes, from the essential matrix",
        "tracker/vision.py:VisionFrontEnd",
        "the motion since then from the essential matrix",
        "tests/tracker/test_vision.py::test_a_translation_has_its_direction",
    ),
    Part(
        "Eq. 2: latitude, longitude and height to ECEF",
        "tracker/geodesy.py:ecef_from_geodetic",
        "eq. 2",
        f"{_GEODESY}test_equation_2_agrees_with_proj",
    ),
    Part(
        "Eq. 3: N",
        "tracker/geodesy.py:prime_vertical_radius_m",
        "eq. 3",
        f"{_GEODESY}test_equation_2_agrees_with_proj",
    ),
    Part(
        "Calibration at rest, about 5000 samples",
        "tracker/calibration.py:RestCalibration",
        "5000 samples",
        f"{_CALIBRATION}test_five_thousand_samples_are_enough",
    ),
    Part(
        "Table of offsets",
        "server/paper/drift.py:Offsets",
        "Calibration parameters found for accelerometer and gyroscope",
        "tests/server/paper/test_drift.py::test_offsets_are_what_the_paper_tables",
    ),
    Part(
        "Mean of four samples",
        "tracker/calibration.py:SampleMean",
        "up to four",
        f"{_CALIBRATION}test_groups_span_at_most_16_ms",
    ),
    Part(
        "Drift before and after: 0.5 degrees a minute",
        "server/paper/attitude.py:simulated",
        "drift at rest",
        "tests/server/paper/test_attitude.py::test_a_resting_rig_drifts_by_no_more_than_the_papers",
    ),
    Part(
        "Eqs. 4 and 5: double integration, axes turned and gravity removed",
        "tracker/inertial.py:InertialPath.step",
        "eqs. 4 and 5",
        "tests/tracker/test_inertial.py::test_constant_acceleration",
    ),
    Part(
        "Eqs. 4 and 5 to the letter: four samples, offsets subtracted",
        "tracker/literal.py:FourSampleIntegral",
        "eqs. 4 and 5",
        "tests/tracker/test_literal.py::test_four_samples_integrate_to_micrometres",
    ),
    Part(
        "The IMU filter of Madgwick's report",
        "tracker/attitude.py:Madgwick",
        "Madgwick",
        "tests/tracker/test_attitude.py::test_agrees_with_ahrs_on_a_turning_rig",
    ),
)

FUSION = (
    Part("Eq. 6: the state of twelve", "tracker/fusion.py:FusionFilter.state", "eq. 6", _SIX_PAIRS),
    Part("Eq. 7: F", "tracker/fusion.py:transition", "eq. 7", _SIX_PAIRS),
    Part(
        "m_R: roll, pitch and yaw of the IMU filter",
        "tracker/sensor_pose.py",
        "m_R is Madgwick's attitude",
        "tests/tracker/test_paper.py::test_stays_within_what_gps_allows",
    ),
    Part(
        "m_P as read by default: the fix, carried on by camera and IMU",
        "tracker/sensor_pose.py",
        "m_P is the fix",
        "tests/tracker/test_paper.py::test_stays_within_what_gps_allows",
    ),
    Part(
        "Eq. 8 to the letter: m_P = Tr x m_gps + m_imu about the site's origin",
        "tracker/literal.py:m_P_enu",
        "eq. 8",
        "tests/tracker/test_literal.py::test_a_step_is_taken_in_the_axes_it_is_written_in",
    ),
    Part(
        "Eq. 8 to the letter, in ECEF",
        "tracker/literal.py:m_P_ecef",
        "eq. 8",
        "tests/tracker/test_literal.py::test_a_tenth_of_a_degree_is_eleven_kilometres",
    ),
    Part("Eq. 9: the update", "tracker/fusion.py:FusionFilter.update", "eq. 9", _SIX_PAIRS),
    Part(
        "Eq. 10: the innovation, split into y_p and y_r",
        "tracker/fusion.py:innovation",
        "eq. 10",
        f"{_FUSION}test_an_innovation_takes_the_shorter_way_round",
    ),
    Part(
        "Magnitudes of y_p and y_r, as they are or by what was expected of them",
        "tracker/cycle.py:CycleFilter._sizes",
        "two magnitudes",
        "tests/tracker/test_cycle.py::test_the_selector_is_told_metres_and_radians",
    ),
    Part(
        "Eqs. 11 and 12: velocity coefficients of position and orientation",
        "tracker/fusion.py:FusionFilter.predict",
        "eqs. 11 and 12",
        f"{_FUSION}test_rest_keeps_the_place_and_double_speed_doubles_the_step",
    ),
    Part(
        "Predict, measure, update",
        "tracker/cycle.py:CycleFilter",
        "predict, measure, update",
        "tests/tracker/test_cycle.py::test_an_innovation_is_what_the_start_did_not_foresee",
    ),
    Part(
        "Threads for the sensors and for vision",
        "tracker/runner.py",
        "thread",
        "tests/tracker/test_runner.py::test_vision_looks_on_its_own_thread_and_survives_a_failure",
    ),
)

FUZZY = (
    Part(
        "Nine motion models PiRj",
        "tracker/fuzzy.py:MotionModel",
        "nine models",
        "tests/tracker/test_motion.py::test_each_names_one_of_the_nine",
    ),
    Part(
        "Constant motion model: P1R1",
        "tracker/motion.py:CONSTANT",
        "correspond[s] to P1R1",
        "tests/tracker/test_paper.py::test_motion_models",
    ),
    Part(
        "Figure: fuzzy rule-based selection of motion models",
        "tracker/motion.py:FuzzyMotion",
        "Fuzzy rule-based selection of motion models",
        "tests/tracker/test_motion.py::test_which_rule_fired_tells_the_next_model",
    ),
    Part(
        "Input membership functions",
        "tracker/fuzzy.py:Membership",
        "Input membership functions",
        f"{_FUZZY}test_memberships_sum_to_one",
    ),
    Part(
        "Table: rule base, the 54 printed rules",
        "tracker/fuzzy.py:NEXT_INDEX",
        "all 54 printed rows",
        f"{_FUZZY}test_the_54_printed_rules_are_ours",
    ),
    Part(
        "Table: rule base, the 27 others",
        "tracker/fuzzy.py:PAPER_RULES",
        "Rule-base for motion models",
        f"{_FUZZY}test_the_27_others_follow_from_symmetry",
    ),
    Part("Rules in a look-up table, one query", "tracker/fuzzy.py:RuleBase", "single query", _ALL_RULES),
    Part("Product t-norm", "tracker/fuzzy.py:FuzzyController", "product t-norm", _ALL_RULES),
    Part(
        "Strength zero for rules of another model",
        "tracker/fuzzy.py:FuzzyController",
        "another present model have strength zero",
        _ALL_RULES,
    ),
    Part(
        "Maximum firing strength",
        "tracker/fuzzy.py:FuzzyController.next_model",
        "the rule that fires most strongly",
        _ALL_RULES,
    ),
    Part("Singleton output", "tracker/fuzzy.py:FuzzyController", "singleton", _ALL_RULES),
    Part(
        "Future work: fewer rules",
        "tracker/fuzzy.py:ReducedController",
        "rule-reduction techniques",
        f"{_FUZZY}test_nine_rules_used_twice_are_the_81",
    ),
    Part(
        "Rival: the authors' earlier automaton",
        "tracker/dfa.py:Automaton",
        "Motion model transitions in GPS-IMU sensor fusion",
        "tests/tracker/test_dfa.py::test_a_word_leads_where_the_table_says",
    ),
    Part(
        "Rival: interacting multiple models",
        "tracker/imm.py:InteractingFilter",
        "interacting multiple model",
        "tests/tracker/test_imm.py::test_three_filters_are_the_nine_of_filterpy",
    ),
)

_DOCUMENT = "tests/server/paper/test_document.py::"

RESULTS = (
    Part(
        "Tables: filter errors of GPS and IMU, and of camera, GPS and IMU, with arrows",
        "server/paper/document/errors.py:errors",
        "the paper's two tables of filter errors",
        f"{_DOCUMENT}test_the_papers_numbers_stand_beneath_ours",
    ),
    Part(
        "The printed numbers of both tables",
        "server/paper/document/printed.py:FILTER_ERRORS",
        "GPS, camera and IMU filter errors",
        f"{_DOCUMENT}test_the_printed_tables",
    ),
    Part(
        "The five datasets, in their printed sizes",
        "tracker/choreography.py:DATASET_UPDATES",
        "sizes of the paper's datasets",
        "tests/tracker/test_choreography.py::test_the_printed_sizes_at_four_a_second",
    ),
    Part(
        "Figure: input membership functions",
        "server/plots/controller.py:membership_figure",
        "Input membership functions",
        "tests/server/plots/test_controller.py::test_memberships_are_drawn_through_their_breakpoints",
    ),
    Part(
        "Figure: output membership function",
        "server/plots/controller.py:output_figure",
        "Output membership function",
        "tests/server/plots/test_controller.py::test_nine_singletons",
    ),
    Part(
        "Table: rule base, drawn whole",
        "server/plots/controller.py:rule_figure",
        "all 81 rules",
        "tests/server/plots/test_controller.py::test_every_rule_has_its_cell",
    ),
    Part(
        "Figures: real and estimated paths",
        "server/plots/paths.py:path_figure",
        "real and estimated paths",
        f"{_RUNS}test_five_ways",
    ),
    Part(
        "Figures: estimated rotations",
        "server/plots/angles.py:angle_figure",
        "estimated rotations",
        f"{_RUNS}test_orientation_in_a_window",
    ),
    Part(
        "Figures: changes in the state covariances",
        "server/plots/covariance.py:covariance_figure",
        "Changes in the state covariances",
        f"{_RUNS}test_covariance_of_the_whole_state",
    ),
    Part(
        "Figures: filter errors, mean dashed",
        "server/plots/innovations.py:innovation_figure",
        "Filter errors",
        f"{_RUNS}test_the_filter_error_and_its_dashed_mean",
    ),
)

PARTS: tuple[Part, ...] = (*SENSORS, *FUSION, *FUZZY, *RESULTS)
