"""A program for rospy as one for rclpy, by the rules of ros2.yaml, call by call; comments stay.

Its node is a variable, so that each line can be compared with the program it is made from. A
program with more to do than to wait for callbacks lets a thread of its own spin the node: rospy
does so, too.
"""

from __future__ import annotations

import ast
import importlib
import inspect
import operator
import re
from collections.abc import Iterator
from pathlib import Path

import rospy
import yaml
from node_basics.records import check_keys
from staging import HERE

KEYS = ("interfaces", "before", "calls", "texts", "imports", "files", "instead")
LOG = re.compile(r"rospy\.log(debug|info|warn|err|fatal)(?:_(once|throttle(?:_identical)?))?")
LEVELS = {"warn": "warning", "err": "error"}
PART = re.compile(r"^(\w+?)(Request|Response)$")
PARTS = r"\1.\2"
SENSORS = {"Image", "LaserScan", "CameraInfo"}
IN_A_THREAD = re.compile(r"rospy\.(on_shutdown|Rate|sleep|is_shutdown)\(")
SIGNALS = "signal_handler_options=SignalHandlerOptions.NO"
SPIN = "threading.Thread(target=rclpy.spin, args=[node], daemon=True).start()"
LONG = r"^(?=.{101})( *)(.*?(?:create_\w+|info|warning|error)\()(.*)$"


def substituted(old: str, new: str, text: str, flags: int) -> str:
    """With one place or more changed; ValueError if there is none."""
    text, count = re.subn(old, new, text, flags=flags)
    if not count:
        raise ValueError(f"ros2.yaml: nothing to change: {old}")
    return text


def read_rules(path: Path) -> dict:
    """The file of rules; ValueError names an unknown key."""
    rules = yaml.safe_load(path.read_text("utf-8"))
    check_keys(path.name, rules, KEYS, ValueError)
    for name, changes in rules["files"].items():
        if unknown := changes.keys() - {"change", "node", "threads", "part"}:
            raise ValueError(f"{path.name}: files: {name}: unknown key '{min(unknown)}'")
    return rules


RULES = read_rules(HERE / "ros2.yaml")


def with_imports(text: str) -> str:
    """A program with what it needs in place of `import rospy`, and nothing that it does not."""
    lines = [line for name, line in RULES["imports"].items()
             if re.search(rf"(?<!\w){name}", text) and f"{line}\n" not in text]
    first = [f"{line}\n" for line in lines if line in ("import atexit", "import threading")]
    if first:  # before all others, which are Python's own or begin with rospy
        begin = re.search("^(import|from (?!__future__))", text, re.MULTILINE).start()
        apart = "import rospy\n" in text[begin:].split("\n\n")[0]
        text = f"{text[:begin]}{''.join(first)}{chr(10) * apart}{text[begin:]}"
    text = text.replace("import rospy\n", "".join(
        f"{line}\n" for line in lines if f"{line}\n" not in first), 1)
    for name in re.findall(r"^import (\w+)$", text, re.MULTILINE):
        if not re.search(rf"\b{name}\.", text):  # only what was left out has used it
            text = text.replace(f"import {name}\n", "")
    return text


class Program:
    """A program, or a part of one, whose node is called `node`."""

    def __init__(self, source: str, name: str = ""):
        """`name`: PACKAGE/FILE, if the rules have changes for this file alone."""
        rules = RULES["files"].get(name, {})
        for old, new in rules.get("change", {}).items():
            source = substituted(old, new, source, re.MULTILINE | re.DOTALL)
        for old, new in RULES["before"].items():
            source = re.sub(old, new, source, flags=re.MULTILINE)
        node = rules.get("node", "node")
        self.source, self.tree, self.node = source.encode(), ast.parse(source), node
        self.begins = [0]
        for line in self.source.splitlines(keepends=True):
            self.begins.append(self.begins[-1] + len(line))
        self.threads = bool(rules.get("threads") or IN_A_THREAD.search(source))
        self.group = ", callback_group=MutuallyExclusiveCallbackGroup()" * (
            "threading.Condition" in source)  # a callback waits for another's: in rospy's threads
        self.messages = {}  # types of messages and services, and parts of these, by name
        self.topics = {}  # the type of what is published by, say, self.publisher
        self.handlers = set()  # names of services' functions
        for each in ast.walk(self.tree):
            if isinstance(each, ast.ImportFrom) and str(each.module).endswith((".msg", ".srv")):
                module = importlib.import_module(each.module)
                self.messages |= {name.name: getattr(module, name.name) for name in each.names}
            elif isinstance(each, ast.Call) and ast.unparse(each.func) == "rospy.Service":
                self.handlers.add(ast.unparse(each.args[2]).removeprefix("self."))
            elif isinstance(each, ast.Assign) and isinstance(each.value, ast.Call) \
                    and ast.unparse(each.value.func) == "rospy.Publisher":
                self.topics[ast.unparse(each.targets[0])] = ast.unparse(each.value.args[1])

    def text(self) -> str:
        """The whole for rclpy; ValueError names what no rule is for."""
        text = self.changed(self.tree, 0, len(self.source))
        interrupt, spin = (("KeyboardInterrupt", "threading.Event().wait()") if self.threads else
                           ("(KeyboardInterrupt, ExternalShutdownException)",
                            "rclpy.spin(node, MultiThreadedExecutor())" if self.group else
                            "rclpy.spin(node)"))
        text = text.replace("rospy.ROSInterruptException", interrupt).replace("rospy.spin()", spin)
        for name in self.handlers:
            text = re.sub(rf"def {name}\((.*)\):", rf"def {name}(\1, _response):", text)
        for old, new in RULES["texts"].items():
            text = re.sub(old.replace("NODE", self.node), new.replace("NODE", self.node), text)
        text = re.sub(LONG, r"\1\2\n\1    \3", text, flags=re.MULTILINE)
        text = with_imports(text)
        if left := re.search(r".*\b(rospy|actionlib|rosgraph|rosbag)\b[.].*", text):
            raise ValueError(f"ros2.yaml: no rule for: {left[0].strip()}")
        return text

    def code(self, node: ast.AST) -> str:
        """The text of a part for rclpy."""
        return self.changed(node, *self.place(node))

    def changed(self, node: ast.AST, begin: int, end: int) -> str:
        """The text from one byte to another, where this node is."""
        parts = []
        for first, last, new in self.changes(node):
            parts += [self.source[begin:first].decode(), new]
            begin = last
        return "".join([*parts, self.source[begin:end].decode()])

    def place(self, node: ast.AST) -> tuple[int, int]:
        """Its first byte, and the one behind it."""
        return (self.begins[node.lineno - 1] + node.col_offset,
                self.begins[node.end_lineno - 1] + node.end_col_offset)

    def changes(self, node: ast.AST) -> Iterator[tuple[int, int, str]]:
        """What is replaced in it, in order."""
        new = self.replacement(node)
        if new is not None:
            yield (*self.place(node), new)
        elif not isinstance(node, ast.JoinedStr):  # Python 3.11 has no places in an f-string
            for part in sorted(self.parts(node), key=self.place):
                yield from self.changes(part)

    def parts(self, node: ast.AST) -> Iterator[ast.AST]:
        """Its parts that have a place; such as a function's arguments have none themselves."""
        for part in ast.iter_child_nodes(node):
            if hasattr(part, "lineno"):
                yield part
            else:
                yield from self.parts(part)

    def replacement(self, node: ast.AST) -> str | None:
        """The new text of a node; None if it stays, or only its parts change."""
        if isinstance(node, ast.UnaryOp) and ast.unparse(node) == "not rospy.is_shutdown()":
            return "rclpy.ok()"
        if isinstance(node, ast.ImportFrom) and str(node.module).endswith((".msg", ".srv")):
            names = dict.fromkeys(PART.sub(r"\1", name.name) for name in node.names)
            package, kind = node.module.split(".")
            own = "_interfaces" * (package in RULES["interfaces"])
            return f"from {package}{own}.{kind} import {', '.join(names)}"
        if isinstance(node, ast.If) and ast.unparse(node.test) == "__name__ == '__main__'" \
                and not isinstance(node.body[0], ast.Try) and "init_node" not in ast.unparse(node):
            calls = "\n".join(f"        {self.code(each)}" for each in node.body)
            return (f'if __name__ == "__main__":\n    try:\n{calls}\n'
                    "    except rospy.ROSInterruptException:\n        pass  # Ctrl-C")
        return self.call(node) if isinstance(node, ast.Call) else None

    def call(self, node: ast.Call) -> str | None:
        """The new text of a call."""
        name = ast.unparse(node.func)
        if log := LOG.fullmatch(name):
            return self.log(node, *log.groups())
        if name == "rospy.init_node":
            return self.start(node)
        if name in RULES["calls"]:
            own = operator.attrgetter(name.removeprefix("rospy."))(rospy)
            given = inspect.signature(own).bind(
                *map(self.code, node.args),
                **{each.arg: self.code(each.value) for each in node.keywords}).arguments
            return self.filled(RULES["calls"][name], given)
        if name in self.messages and (node.args or PART.fullmatch(name)):
            return self.message(name, node)
        kind = self.topics.get(name.removesuffix(".publish"))
        if kind and name.endswith(".publish") and not re.match(
                rf"{re.escape(name)}\((msg\)|{kind}\()", ast.unparse(node)) and (
                len(node.args) != 1 or self.messages[kind].__slots__ == ["data"]):
            return f"{self.code(node.func)}({self.message(kind, node)})"
        return None

    def filled(self, rule: str, given: dict[str, str]) -> str:
        """A rule with what the call gives."""
        depth, span = given.get("queue_size", "10"), given.get("duration", "")
        qos = ("qos_profile_sensor_data" if given.get("data_class") in SENSORS and "callback"
               in given else depth if given.get("latch") != "True" else
               f"QoSProfile(depth={depth}, durability=DurabilityPolicy.TRANSIENT_LOCAL)")
        values = {"qos": qos, "node": self.node, "group": self.group, "argv": "sys.argv",
                  "secs": "0", "nsecs": "0", "default": "None"} | given
        values["duration"] = span if "Duration" in span else f"Duration(seconds={span})"
        values["period"] = re.sub(r"^Duration\(seconds=(.*)\)$", r"\1", given.get("period", ""))
        values["name"] = re.sub(r'^(f?")~', r"\1~/", given.get("name", ""))
        values["param_name"] = given.get("param_name", "").replace("~", "")
        return rule.format(**values)

    def log(self, node: ast.Call, level: str, how: str | None) -> str:
        """A line of the log: rclpy takes one text, and options."""
        texts = [self.code(each) for each in node.args]
        option = {None: "", "once": ", once=True"}.get(how)
        if option is None:
            option = f", throttle_duration_sec={texts.pop(0)}"
        text, *values = texts
        if values:
            text += f" % ({', '.join(values)}{',' * (len(values) == 1)})"
        return f"{self.node}.get_logger().{LEVELS.get(level, level)}({text}{option})"

    def message(self, name: str, node: ast.Call) -> str:
        """A message of this type: in ROS 2 each value has its name, and a float is no int."""
        kind = self.messages[name]
        types = dict(zip(kind.__slots__, kind._slot_types))
        values = dict(zip(kind.__slots__, map(self.code, node.args)))
        values |= {each.arg: self.code(each.value) for each in node.keywords}
        shown = [f"{key}={value}{'.0' * (types[key].startswith('float') and value.isdigit())}"
                 for key, value in values.items()]
        return f"{PART.sub(PARTS, name)}({', '.join(shown)})"

    def start(self, call: ast.Call) -> str:
        """The node is made, and spun in a thread if the program has more to do."""
        lines = [f"rclpy.init({SIGNALS})" if self.threads else "rclpy.init()",
                 f"node = rclpy.create_node({self.code(call.args[0])})"]
        if self.threads:
            lines.append(SPIN)
        (place,) = [each for each in self.tree.body
                    if any(part is call for part in ast.walk(each))]
        if isinstance(place, ast.FunctionDef) and any(
                re.search(r"rospy\.(?!ROSInter|Duration)|\bnode\b", ast.unparse(each))
                for each in self.tree.body if each is not place):
            lines.insert(0, "global node")
        return f"\n{' ' * call.col_offset}".join(lines)
