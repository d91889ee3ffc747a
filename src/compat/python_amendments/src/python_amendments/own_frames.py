"""A traceback without the lines of these amendments, in which a learner has nothing to mend."""

HERE = "/python_amendments/"


def drop_own_frames(error, started):
    """Take them out of an error and of those that it comes from; `started`: usercustomize.py."""
    waiting, seen = [error], set()
    while waiting:
        error = waiting.pop()
        if error is None or id(error) in seen:
            continue
        seen.add(id(error))
        waiting += error.__cause__, error.__context__
        kept = [each for each in frames(error.__traceback__) if not (
            each.tb_frame.f_code.co_filename == started
            or HERE in each.tb_frame.f_code.co_filename)]
        for each, following in zip(kept, [*kept[1:], None], strict=True):
            each.tb_next = following
        error.__traceback__ = kept[0] if kept else error.__traceback__


def frames(trace):
    """The entries of a traceback, the outermost first."""
    found = []
    while trace is not None:
        found.append(trace)
        trace = trace.tb_next
    return found
