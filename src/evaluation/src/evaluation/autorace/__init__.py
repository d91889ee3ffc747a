"""AutoRace 2020 by the lessons of learning_autorace, scored mission by mission."""
