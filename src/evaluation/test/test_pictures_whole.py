"""Charts are whole or not there."""

import errno
import subprocess
import sys
import textwrap

# In a process of its own, whose files may get no longer than 3000 bytes: as on a full disk.
DRAW = textwrap.dedent("""
    import resource, signal, sys
    from pathlib import Path
    from evaluation.picture import chart

    import matplotlib.font_manager  # writes a cache at first
    signal.signal(signal.SIGXFSZ, signal.SIG_IGN)  # else it ends the process
    resource.setrlimit(resource.RLIMIT_FSIZE, (3000, 3000))
    try:
        with chart(Path(sys.argv[1]), 1, 1) as ((axes,),):
            axes.plot([0, 1], [0, 1])
    except OSError as refused:
        print(refused.errno, refused.filename)
""")


def test_a_chart_that_cannot_be_written_leaves_no_file(tmp_path):
    path = tmp_path / "trials.png"
    done = subprocess.run([sys.executable, "-c", DRAW, str(path)], capture_output=True, text=True,
                          timeout=120, check=False)
    assert done.stdout.split() == [str(errno.EFBIG), str(path)], done.stderr
    assert list(tmp_path.iterdir()) == []
