"""How accurate the trackers are: simulated walks with faults of their own, recorded ones, and rivals on the same measurements."""
