"""`make soak`: long runs of the live path, with figures, limits and verdicts in docs/soak.md."""
