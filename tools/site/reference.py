"""A page for each Gazebo plugin and each controller, of the interface's table and what is read."""

from __future__ import annotations

import math
import re
import sys
import xml.etree.ElementTree as ET
from pathlib import PurePosixPath

import yaml
from recording import Seen, bench, watched_controller, watched_plugin
from staging import HERE, ROOT, SAYS, Pages, table

from bullet_sim.control.parameters import REQUIRED
from bullet_sim_ros.interface import ABSENT, Entry, documented

sys.path.append(str(ROOT / "scripts"))
from interface_table import WORDS

PLUGINS, CONTROLLERS = "reference/plugins", "reference/controllers"
TEST = "src/sim/bullet_sim_ros/test/conformance/test_tags_of_every_plugin.py"
UNITS = {name: unit for unit, names in
         yaml.safe_load((HERE / "units.yaml").read_text("utf-8")).items() for name in names}


def add_reference(pages: Pages) -> None:
    """Add all plugins and controllers; PluginError if an example does not load."""
    rows = {name: row for name, row in documented().items()
            if name.endswith(".so") and row.status != ABSENT}
    examples = yaml.safe_load((HERE / "controllers.yaml").read_text("utf-8"))
    types = documented()["controllers"].tags
    with bench() as made:
        plugins = {name: watched_plugin(name, made) for name in rows}
        controllers = {kind: watched_controller(kind, example, made)
                       for kind, example in examples.items()}
    for language, texts in pages.texts.items():
        index = []
        for name, (model, seen) in plugins.items():
            file = f"{PurePosixPath(name).stem}.md"
            tree = ET.fromstring(model)
            ET.indent(tree)
            texts[f"{PLUGINS}/{file}"] = page(language, rows[name], seen, "tag", rows[name].tags, (
                "xml", ET.tostring(tree, "unicode"), TEST))
            index.append((f"[`{name}`]({file})", SAYS[language][rows[name].does],
                          WORDS[language][rows[name].status]))
        texts[f"{PLUGINS}/README.md"] = "\n".join([
            SAYS[language]["plugins"], *table(language, "name, kind, status", index)])
        index = []
        for kind, seen in controllers.items():
            file = re.sub(r"\W", "_", kind) + ".md"
            (parameters,) = examples[kind].values()
            text = yaml.safe_dump({"my_controller": {"type": kind, **parameters}}, width=90,
                                  sort_keys=False, default_flow_style=None)
            texts[f"{CONTROLLERS}/{file}"] = page(language, types[kind], seen, "parameter", None, (
                "yaml", text.rstrip(), "test/test_site.py"))
            index.append((f"[`{kind}`]({file})", WORDS[language][types[kind].status]))
        texts[f"{CONTROLLERS}/README.md"] = "\n".join([
            SAYS[language]["controllers"], *table(language, "name, status", index)])


def page(language: str, entry: Entry, seen: Seen, what: str, tags: dict[str, Entry] | None,
         example: tuple[str, str, str]) -> str:
    """The page of a plugin or a controller.

    `what`: how what it reads is called; `tags`: the interface's entries of them; `example`: its
    language, its text, and the test that loads it.
    """
    says, rows = SAYS[language], []
    for name in dict.fromkeys([*seen.read, *(tags or ())]):
        numeric, default = seen.read.get(name, (False, None))
        unit = UNITS.get(f"{entry.name}/{name.rpartition('/')[2]}") or (
            numeric and UNITS.get(name.rpartition("/")[2])) or ""
        note = [] if tags is None else [
            _status(tags[name], language, quiet=True) if name in tags else ""]
        rows.append((f"`{name}`", _default(default, says), unit, *note))
    topics = [(says[side], f"`{name}`", f"`{kind}`") for side in ("published", "heard", "served")
              for name, kind in getattr(seen, side).items()
              if not kind.startswith("dynamic_reconfigure/")]
    kind, text, test = example
    return "\n".join([
        f"# {entry.name}", "", _status(entry, language), "",
        *(table(language, f"{what}, default, unit{', note' * (tags is not None)}", rows)
          or [says["no tags"], ""]),
        *([f"## {says['topics']}", "", says["names"], ""] if topics else []),
        *table(language, "way, name, type", topics), f"## {says['example']}", "",
        f"{says['loaded']} (`{test}`).", "", f"```{kind}", text, "```", ""])


def _status(entry: Entry, language: str, quiet: bool = False) -> str:
    """`works`, or what else; `quiet`: nothing for what simply works."""
    words = WORDS[language]
    how = (entry.how_zh if language == "zh" else entry.how).replace("|", "\\|")
    status = "" if quiet and entry.status == "works" else words[entry.status]
    return f"{status}{words['colon'] if status and how else ''}{how}"


def _default(value: object, says: dict) -> str:
    if value is REQUIRED:
        return says["required"]
    if value is None or value == "" or value == []:
        return "–"
    if isinstance(value, bool):
        return f"`{str(value).lower()}`"
    if isinstance(value, float | int):
        return says["no limit"] if math.isinf(value) or abs(value) > 1e18 else f"`{value:g}`"
    if isinstance(value, tuple | list):
        return f"`{' '.join(f'{item:g}' for item in value)}`"
    named = {"chassis": says["link"], "bot": says["model"], "/bot": says["model"]}
    return named.get(str(value), f"`{value}`")
