"""Several servers as one: every session is known to all of them, and lives where its rig is."""
