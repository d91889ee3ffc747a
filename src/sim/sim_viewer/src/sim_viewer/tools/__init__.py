"""What rqt's tools do: one file, one tab of the page."""
