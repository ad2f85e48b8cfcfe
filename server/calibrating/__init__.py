"""`agora calibrate`: sensors or a recording in, tables of the rig file out, with figures that show how good they are."""
