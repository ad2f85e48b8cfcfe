"""Calibrations of a rig's sensors: pure functions from what sensors said to sheets of the rig file."""
