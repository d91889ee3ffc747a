"""What stands where rqt's windows would: the page in the browser, or a command."""
