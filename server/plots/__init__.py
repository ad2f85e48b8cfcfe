"""The report's figures: pure functions from data to a matplotlib figure, each with the sentence that says what it shows."""
