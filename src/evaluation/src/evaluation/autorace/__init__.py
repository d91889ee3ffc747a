"""AutoRace 2020 driven by the lessons of learning_autorace, scored mission by mission."""
