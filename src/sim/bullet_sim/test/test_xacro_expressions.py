"""Expressions of xacro: what public robots compute, and nothing that reaches beyond it."""

from xml.etree import ElementTree
from xml.sax.saxutils import quoteattr

import pytest

from bullet_sim.errors import FormatError
from bullet_sim.formats.xacro.files import expand, expand_file


@pytest.fixture
def value(tmp_path):
    """The value of an attribute, after these lines."""

    def expanded(text, lines=""):
        path = tmp_path / "robot.xacro"
        path.write_text(f'<robot name="r" xmlns:xacro="http://www.ros.org/wiki/xacro">{lines}'
                        f"<link name={quoteattr(text)}/></robot>", encoding="utf-8")
        return ElementTree.fromstring(expand(path)).find("link").get("name")

    return expanded


@pytest.mark.parametrize("text, expected", [
    ("${2 * (1 + 3) ** 2 / 4 % 5 - -1}", "4.0"),
    ("${1 if not False and 2 > 1 in [1, 2] else 3}", "1"),
    ("${[i * 2 for i in range(4) if i > 1][0]}", "4"),
    ("$(eval {i: str(i) for i in [1, 2]}[2] + 'x')", "2x"),
    ("${max(x for x in (3, 1, 2))}", "3"),
    ("${sin(pi / 2) + math.cos(0) + radians(180) / math.pi}", "3.0"),
    ("${'left_wheel'.split('_')[1].upper()}", "WHEEL"),
    ("${' '.join(map(str, sorted([3, 1])))}", "1 3"),
    ("$(eval '{}_{name:>3}'.format(1, name='a'))", "1_  a"),
    ("${list(map(str.upper, 'ab'))[1]}", "B"),
    ("${dict(a=1).get('b', 5)}", "5"),
    ("${'%s_%02d' % ('a', 3)}", "a_03"),
    ("$(eval f'{1 + 1:03d}')", "002"),
    ("${'abc'[::-1][:2]}", "cb"),
    ("${python.isinstance(1, int) and python.type(1.5) == float}", "True"),
    ("${size.wheel.radius * size['wheel'].get('count')}", "2.0"),
    ("${size.items().__len__ if False else len(size.items())}", None),
    ("$(eval 1 + len('abc'))", "4"),
    ("${xacro.tokenize('a b')[1]}", "b"),
    ("${1 / 2}", "0.5"),
    ("a${1}b", "a1b"),
    ("${python.abs(-1)}", "1"),
    ("${xacro.arg('n')}", "3"),
])
def test_what_robots_compute(value, text, expected):
    # conforms: xacro expressions, xacro expressions/arithmetic, xacro expressions/math
    # conforms: xacro expressions/lists and dicts, xacro expressions/python.*
    # conforms: xacro expressions/xacro.arg
    properties = ('<xacro:arg name="n" default="3"/><xacro:property name="size" '
                  'value="${xacro.dotify(dict(wheel=dict(radius=0.5, count=4)))}"/>')
    if expected is None:
        with pytest.raises(FormatError, match="invalid name"):
            value(text, properties)
    else:
        assert value(text, properties) == expected


@pytest.mark.parametrize("call", ["load_yaml", "xacro.load_yaml"])
def test_yaml(value, tmp_path, call):
    # conforms: xacro expressions/load_yaml, xacro expressions/xacro.load_yaml
    (tmp_path / "c.yaml").write_text("a: {b: [1, 2.5]}\nturn: !degrees 180\n")
    before = f"""<xacro:property name="c" value="${{{call}('c.yaml')}}"/>"""
    assert value("${c['a']['b'][1]} ${c.a.b[0]} ${round(c.turn, 2)}", before) == "2.5 1 3.14"
    assert str(tmp_path / "c.yaml") in expand_file(tmp_path / "robot.xacro").files


REACH = "__class__.__base__.__subclasses__()"


@pytest.mark.parametrize("expression", [
    f"[c for c in [().{REACH}]]", f"().{REACH}", "[().__class__ for x in [1]]",
    "(x for x in [1]).gi_frame.f_back.f_builtins", "[g.gi_frame for g in [(x for x in [1])]]",
    "vars(list)", "python.vars(list)", "type('A', (object,), dict())", "type(len)", "type(int)",
    "int.mro()", "math.__loader__", "len.__self__", "xacro.load_yaml.__globals__",
    "python.str.mro()", "xacro.arg.__closure__", "math.root", "math.parent", "python.top()",
    "lambda: 1", "(y := 1)", "[print(1)]", "getattr(1, 'real')", "eval('1')", "__import__('os')",
    "open('x')", "globals()", "__builtins__", "1 .__add__(2)", "radians.__self__",
    "dict.fromkeys([1]).__class__", "'a'.encode('idna')", "list.__subclasses__",
])
@pytest.mark.parametrize("form", ["${%s}", "$(eval %s)"])
def test_nothing_beyond_is_reached(value, form, expression):
    with pytest.raises(FormatError) as caught:
        value(form % expression)
    text = str(caught.value)
    assert "\n" not in text
    assert any(words in text for words in (
        "invalid name", "may not be used", "not defined", "takes", "invalid", "double underscore"))


@pytest.mark.parametrize("expression", [
    "'{0.__class__}'.format(1)", "'{a[0]}'.format(a=[1])", "str.format('{0.real}', 1)",
    "'{:{0.real}}'.format(1)", "str.format_map('{a}', dict(a=1))",
])
def test_a_format_reaches_no_attribute(value, expression):
    with pytest.raises(FormatError, match=r"invalid name|double underscore"):
        value(f"$(eval {expression})")


def test_a_list_comprehension_reaches_no_system_call(value, tmp_path):
    made = tmp_path / "made"
    with pytest.raises(FormatError, match="invalid name"):
        value("${[c.__init__.__globals__['system']('touch " + str(made) + f"') for c in ().{REACH} "
              "if c.__name__ == '_wrap_close']}")
    assert not made.exists()
