"""The watch over the disk while a bag is recorded."""

from types import SimpleNamespace

from sim_viewer.tools import bags


def test_a_folder_that_goes_away_ends_the_recording_with_a_word(tmp_path):
    asked = []
    recording = SimpleNamespace(running=True)

    def interrupt():
        asked.append("interrupt")
        recording.running = False

    recording.interrupt = interrupt
    kept = bags.Bags(SimpleNamespace(options=SimpleNamespace(bags=str(tmp_path / "bags"))))
    kept.folder = tmp_path / "gone"
    kept._guard(recording)
    assert asked == ["interrupt"]
    assert kept.note == f"{tmp_path / 'gone'}: No such file or directory"
