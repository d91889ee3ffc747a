"""What rqt's tools do: a module for each tab and for the simulation's bar, and what they share."""
