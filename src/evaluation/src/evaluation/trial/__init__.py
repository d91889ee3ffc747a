"""One protocol for all trials: cases, options, runner, table, report."""
