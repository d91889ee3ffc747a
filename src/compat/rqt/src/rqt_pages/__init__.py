"""rqt's tools without windows: each names the browser page or the command that replaces it."""
