"""Ends a roslaunch that empty_world.launch's guard has refused, after the guard's one line."""

GUARD, REFUSED = "/unless_running ", "with code [1]"


def amend_loader(loader):
    """Let a refusal end roslaunch with exit code 1; `loader` is the module roslaunch.loader.

    roslaunch itself would call it an invalid <param> tag, on three more lines.
    """
    value_of = loader.Loader.param_value

    def param_value(self, *words):
        try:
            return value_of(self, *words)
        except ValueError as error:
            if GUARD in str(words[-1]) and REFUSED in str(error):
                raise SystemExit(1) from None
            raise

    loader.Loader.param_value = param_value
