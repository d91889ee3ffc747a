"""Machine code that was kept is stale when a file that it was made from has changed."""

from nav_algorithms import compiled


def names_of(name: str) -> set[str]:
    """Files, without suffix, that the stamp of a module looks at."""
    return {path.stem for path in compiled._sources(compiled.PACKAGE / name)}


def test_the_stamp_follows_both_ways_of_importing():
    assert {"footprint", "likelihood_field", "compiled"} <= names_of("costmap/footprint.py")
    assert {"particle_slam", "poses", "hit_maps"} <= names_of("particle_slam.py")
    assert "rays" not in names_of("poses.py")


def test_the_stamp_changes_with_what_is_called(tmp_path, monkeypatch):
    monkeypatch.setattr(compiled, "PACKAGE", tmp_path)
    caller, callee = tmp_path / "caller.py", tmp_path / "callee.py"
    caller.write_text("from nav_algorithms.callee import one\n")
    callee.write_text("one = 1\n")

    def stamp() -> str:
        compiled._text.cache_clear()
        locator = compiled.BesideSource.__new__(compiled.BesideSource)
        locator._py_file = str(caller)
        return locator.get_source_stamp()

    before = stamp()
    assert stamp() == before
    callee.write_text("one = 2\n")
    assert stamp() != before
    compiled._text.cache_clear()
