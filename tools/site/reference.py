"""A page for each Gazebo plugin and each controller, of the interface's table and what is read."""

from __future__ import annotations

import math
import re
import sys
import xml.etree.ElementTree as ET
from collections.abc import Iterator
from pathlib import PurePosixPath

import yaml
from recording import Seen, bench, watched_controller, watched_plugin
from staging import HERE, ROOT, Pages

from bullet_sim.control.parameters import REQUIRED
from bullet_sim_ros.interface import ABSENT, Entry, Row, documented
from bullet_sim_ros.plugins import register_plugins

sys.path.append(str(ROOT / "scripts"))
from interface_table import WORDS

PLUGINS, CONTROLLERS = "reference/plugins", "reference/controllers"
TEST = "src/sim/bullet_sim_ros/test/conformance/test_tags_of_every_plugin.py"
SAYS = {
    "en": {"tag": "tag", "parameter": "parameter", "default": "default", "unit": "unit", "": "",
           "note": "note", "none": "none", "required": "required", "link": "the link's name",
           "model": "the model's name", "more": "read only beside other tags",
           "topics": "Topics and services", "way": "", "name": "name", "type": "type",
           "published": "publishes", "heard": "subscribes to", "served": "service",
           "example": "Example", "no tags": "It reads no tags.", "no limit": "no limit",
           "names": "Names as with the example below.",
           "loaded": "The simulator loaded this when the page was made; the tests do, too",
           "plugins": "Gazebo plugins", "controllers": "Controllers of ros_control",
           "kind": "for", "sensor": "a sensor", "actuator": "moving things", "world": "the world",
           "visual": "a visual", "status": "",
           "plugin list": "Tags, defaults, units and topics of each plugin, read from the "
           "simulator itself. Deviations are in [the table of the whole interface]"
           "(../../docs/interface.md).",
           "controller list": "Parameters, defaults and topics of each controller, read from the "
           "simulator itself. A YAML file with them is loaded with `<rosparam file=…/>`, and "
           "`rosrun controller_manager spawner my_controller` starts it. `a` and `b` are joints."},
    "zh": {"tag": "标签", "parameter": "参数", "default": "默认值", "unit": "单位", "": "",
           "note": "说明", "none": "无", "required": "必填", "link": "连杆名",
           "model": "模型名", "more": "只在有其他标签时读取",
           "topics": "话题与服务", "way": "", "name": "名称", "type": "类型",
           "published": "发布", "heard": "订阅", "served": "服务",
           "example": "示例", "no tags": "它不读取任何标签。", "no limit": "不限",
           "names": "名称以下面的示例为准。",
           "loaded": "生成本页时仿真器加载过这个示例，测试也会加载",
           "plugins": "Gazebo 插件", "controllers": "ros_control 控制器",
           "kind": "用途", "sensor": "传感器", "actuator": "运动", "world": "世界",
           "visual": "外观", "status": "",
           "plugin list": "每个插件的标签、默认值、单位和话题，直接从仿真器读出。"
           "与原版的差别见[整个接口的表格](../../docs/interface.md)。",
           "controller list": "每个控制器的参数、默认值和话题，直接从仿真器读出。"
           "参数写在 YAML 文件里，用 `<rosparam file=…/>` 加载，"
           "再用 `rosrun controller_manager spawner my_controller` 启动。`a`、`b` 是关节名。"},
}
UNITS = {name: unit for unit, names in
         yaml.safe_load((HERE / "units.yaml").read_text("utf-8")).items() for name in names}


def add_reference(pages: Pages) -> None:
    """Add all plugins and controllers; PluginError if an example does not load."""
    register_plugins()
    rows = {name: row for name, row in documented().items()
            if name.endswith(".so") and row.status != ABSENT}
    examples = yaml.safe_load((HERE / "controllers.yaml").read_text("utf-8"))
    types = documented()["controllers"].tags
    with bench() as made:
        plugins = {name: watched_plugin(name, made) for name in rows}
        controllers = {kind: watched_controller(kind, example, made)
                       for kind, example in examples.items()}
    for language, texts in pages.texts.items():
        says = WORDS[language] | SAYS[language]
        for name, (model, seen) in plugins.items():
            texts[f"{PLUGINS}/{PurePosixPath(name).stem}.md"] = plugin_page(
                rows[name], model, seen, says, language)
        for kind, seen in controllers.items():
            texts[f"{CONTROLLERS}/{_file(kind)}.md"] = controller_page(
                types[kind], examples[kind], seen, says, language)
        texts[f"{PLUGINS}/README.md"] = "\n".join([
            f"# {says['plugins']}", "", says["plugin list"], "",
            f"| {says['name']} | {says['kind']} | {says['status']} |", "|---|---|---|",
            *(f"| [`{name}`]({PurePosixPath(name).stem}.md) | {says[row.does]} | "
              f"{says[row.status]} |" for name, row in rows.items())])
        texts[f"{CONTROLLERS}/README.md"] = "\n".join([
            f"# {says['controllers']}", "", says["controller list"], "",
            f"| {says['name']} | {says['status']} |", "|---|---|",
            *(f"| [`{kind}`]({_file(kind)}.md) | {says[types[kind].status]} |"
              for kind in controllers)])


def plugin_page(row: Row, model: str, seen: Seen, says: dict, language: str) -> str:
    """The page of a plugin."""
    names = list(dict.fromkeys([*seen.read, *row.tags]))
    lines = [f"# {row.name}", "", _status(row, says, language), ""]
    lines += [f"| {says['tag']} | {says['default']} | {says['unit']} | {says['note']} |",
              "|---|---|---|---|"] if names else [says["no tags"]]
    for name in names:
        kind, default = seen.read.get(name, ("", None))
        note = _status(row.tags[name], says, language, quiet=True) if name in row.tags else ""
        lines.append(f"| `{name}` | {_default(default, says)} | {_unit(row.name, name, kind)} | "
                     f"{note} |")
    tree = ET.fromstring(model)
    ET.indent(tree)
    return "\n".join([*lines, "", *_topics(seen, says), f"## {says['example']}", "",
                      f"{says['loaded']} (`{TEST}`).", "", "```xml",
                      ET.tostring(tree, "unicode"), "```", ""])


def controller_page(entry: Entry, example: dict, seen: Seen, says: dict, language: str) -> str:
    """The page of a controller."""
    (parameters,) = example.values()
    text = yaml.safe_dump({"my_controller": {"type": entry.name, **parameters}}, sort_keys=False,
                          default_flow_style=None, width=90)
    lines = [f"# {entry.name}", "", _status(entry, says, language), "",
             f"| {says['parameter']} | {says['default']} | {says['unit']} |", "|---|---|---|"]
    lines += [f"| `{name}` | {_default(default, says)} | {_unit(entry.name, name, kind)} |"
              for name, (kind, default) in seen.read.items()]
    return "\n".join([*lines, "", *_topics(seen, says), f"## {says['example']}", "",
                      f"{says['loaded']} (`test/test_site.py`).", "", "```yaml", text.rstrip(),
                      "```", ""])


def _topics(seen: Seen, says: dict) -> Iterator[str]:
    rows = [f"| {says[side]} | `{name}` | `{kind}` |" for side in ("published", "heard", "served")
            for name, kind in getattr(seen, side).items()
            if not kind.startswith("dynamic_reconfigure/")]
    if rows:
        yield from (f"## {says['topics']}", "", says["names"], "",
                    f"| {says['way']} | {says['name']} | {says['type']} |", "|---|---|---|", *rows,
                    "")


def _status(entry: Entry, says: dict, language: str, quiet: bool = False) -> str:
    """`works`, or what else; `quiet`: nothing for what simply works."""
    how = (entry.how_zh if language == "zh" else entry.how).replace("|", "\\|")
    status = "" if quiet and entry.status == "works" else says[entry.status]
    return f"{status}{says['colon'] if status and how else ''}{how}"


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


def _unit(owner: str, name: str, kind: str) -> str:
    last = name.rpartition("/")[2]
    unit = UNITS.get(f"{owner}/{last}") or (UNITS.get(last) if kind.startswith("number") else None)
    return unit or ""


def _file(kind: str) -> str:
    """A type's name as a file's: package_Class."""
    return re.sub(r"\W", "_", kind)
