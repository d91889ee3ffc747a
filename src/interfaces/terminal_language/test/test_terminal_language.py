"""Which language is wanted, how a text is found in a catalogue, and what a stream writes."""

import io
import os
import pathlib
import subprocess
import sys
import time

import pytest
from terminal_language import heading, translated
from terminal_language.catalogue import Catalogue, Sentence, read_catalogue
from terminal_language.cells import cut, width
from terminal_language.streams import TranslatedStream
from terminal_language.wanted import home, is_ours, wanted_language

SOURCE = pathlib.Path(__file__).resolve().parents[1] / "src"
START = SOURCE.parents[2] / "compat/python_amendments/src"  # has usercustomize.py
CATALOGUE = Catalogue({
    "": "header", "the line is lost": "线丢了", "no such file": "没有这个文件",
    "{0} has no {1}": "{0} 没有{1}", "{0} has no joint called {1}": "{0} 没有名为 {1} 的关节",
    "give one of: {0}": "请从中选一个：{0}", "first {0}, then {1}": "{1} 之前先 {0}",
    "not translated yet": "", "(did you mean {0}?)": "（是不是 {0}？）", "no {0} here": "没有 {0}",
    "Error: no {0} here": "Error: no {0} here"})


@pytest.mark.parametrize(("environment", "language"), [
    ({"LANG": "zh_CN.UTF-8"}, "zh_CN"), ({"LANG": "zh_TW.UTF-8"}, "zh_CN"),
    ({"LC_ALL": "C.UTF-8", "LANGUAGE": "zh_CN"}, "zh_CN"), ({"LANGUAGE": "zh_CN:en"}, "zh_CN"),
    ({"LANG": "zh_CN.UTF-8", "LANGUAGE": "en"}, None), ({"LC_ALL": "C", "LANGUAGE": "zh_CN"}, None),
    ({"LANG": "zh_CN.UTF-8", "LC_ALL": "en_US.UTF-8"}, None),
    ({"LANG": "en_US.UTF-8", "LC_MESSAGES": "zh_CN.UTF-8"}, "zh_CN"),
    ({"LANG": "de_DE.UTF-8"}, None), ({}, None), ({"LC_ALL": "", "LANG": "zh"}, "zh_CN")])
def test_the_locale_decides(environment, language):
    assert wanted_language(environment) == language


@pytest.mark.parametrize(("words", "ours"), [
    (["python3", f"{home()}/src/evaluation/scripts/course_run.py", "-c"], True),
    (["python3", "-u", f"{home()}/devel/lib/x/y.py"], True),
    (["python3", "/usr/bin/rostopic"], False),
    (["python3", "/home/learner/catkin_ws/src/a/scripts/b.py"], False),
    (["python3", "-c", "x"], False),
    (["python3", "-P", "-X", "gzserver", "-m", "terminal_language"], True),
    (["python3"], False), (["python3", "-m", "pytest"], False),
    (["python3", "-m", "terminal_language"], True)])
def test_only_our_programs_are_translated(words, ours):
    assert is_ours(words) is ours


@pytest.mark.parametrize(("english", "chinese"), [
    ("the line is lost", "线丢了"),
    ("\r\x1b[33m[WARN] [12.3, 4.5]: the line is lost\x1b[0m\n",
     "\r\x1b[33m[WARN] [12.3, 4.5]: 线丢了\x1b[0m\n"),
    ("arm has no grip", "arm 没有 grip"),
    ("arm has no joint called a b", "arm 没有名为 a b 的关节"),
    ("check: a.world: no such file; give one of: b, c",
     "check: a.world: 没有这个文件; 请从中选一个：b, c"),
    ("give one of: the line is lost", "请从中选一个：线丢了"), ("first a, then b", "b 之前先 a"),
    ("the line is lost\nx\n  no such file\n", "线丢了\nx\n  没有这个文件\n"),
    ("[gzclient] the line is lost", "[gzclient] 线丢了"),
    ("no x here (did you mean y?); no such file", "没有 x（是不是 y？）; 没有这个文件"),
    ("arm has no no such file", "arm 没有没有这个文件"), ("线 has no 3", "线没有 3"),
    ("no such file (3)", "没有这个文件 (3)"),
    ("Error: no x here", "Error: no x here"), ('  <link name="no such file"/>\n',) * 2,
    ("not translated yet", "not translated yet"), ("", ""), ("\n", "\n"), ("what?", "what?")])
def test_a_text_is_found_with_what_stands_around_it_and_in_it(english, chinese):
    assert CATALOGUE.translate(english) == chinese


@pytest.mark.parametrize(("english", "chinese"), [
    ("rosdep: compressed_image_transport: Debian 13 has it, Debian 12 does not",
     "rosdep: compressed_image_transport: Debian 13 有，Debian 12 没有"),
    ("rosdep: rosserial (for x): not in Debian; the simulator's sensors publish what a driver "
     "would", "rosdep: rosserial (for x): Debian 里没有；驱动该发布的消息，由仿真器的传感器发布"),
    ("a.world, line 1: write no -- within a comment; line 2: move <?xml ...?> to the beginning; "
     'line 3: write a="..." with quotes; line 4: write b="..." with quotes; line 5: write c="..." '
     "with quotes; line 6: remove what follows the root element; taken all the same, as by Gazebo",
     "a.world，第 1 行：注释里不要写 --; 第 2 行：请把 <?xml ...?> 移到最开头; "
     '第 3 行：请加引号写成 a="..."; 第 4 行：请加引号写成 b="..."; 第 5 行：请加引号写成 c="..."; '
     "第 6 行：请去掉根元素后面的内容；和 Gazebo 一样照样读取"),
    ("mark: --submissions (SUBMISSIONS=) is missing: a folder of submissions",
     "mark: 缺少 --submissions（SUBMISSIONS=）：放作业的文件夹"),
    ("legs cannot be built: a: nobody has that name; is b meant? (CMakeLists.txt asks for it)",
     "legs 不能编译：a：没有叫这个名字的包；是不是想写 b？（CMakeLists.txt 需要它）"),
    ("a: it will be without: not in Debian; gmapping makes a map from the same topics (rosrun "
     "gmapping slam_gmapping), hector_mapping without odometry (package.xml asks for it)",
     "a: 它会缺少：Debian 里没有；gmapping 用同样的话题建图（rosrun gmapping slam_gmapping），"
     "hector_mapping 不需要里程计（package.xml 需要它）"),
    ("mark: a.yaml: missing key 'b'; there are: course, program, points, limits",
     "mark: a.yaml：没有键 'b'；可用的有：course, program, points, limits"),
    ("check_exercise: no exercise 'white_lane' (did you mean white_line?); there are: a, b",
     "check_exercise: 没有练习 'white_lane'（是不是 white_line？）；可用的有：a, b"),
    ("Invalid XML: not well-formed (invalid token): line 1, column 27 (file len.urdf)",
     "Invalid XML: 格式不正确（无效符号）: 第 1 行第 27 列（文件 len.urdf）"),
    ("/a/movng.world not found (searched: /a) (did you mean moving.world?); there are: /a/moving",
     "找不到 /a/movng.world（找过：/a）（是不是 moving.world？）; 有：/a/moving"),
    ("input is no model. (the text is not well-formed XML: not well-formed (invalid token) at "
     "line 1, column 2)", "input is no model. (the text is not well-formed XML: not well-formed "
     "(invalid token) at line 1, column 2)"),
    ("navigate: --map a.yaml: no such file; it is a map's NAME.yaml",
     "navigate: --map a.yaml：没有这个文件；应该是地图的 名字.yaml"),
    ("a.world, line 1: write &amp; for &; line 2: write b=\"...\" with quotes; taken all the same, "
     "as by Gazebo",
     'a.world，第 1 行：请把 & 写成 &amp;; 第 2 行：请加引号写成 b="..."；和 Gazebo 一样照样读取'),
    ("model 'm' <pose>: '1 2 x' is not 6 numbers; 0 0 0 0 0 0 is used instead",
     "model 'm' <pose>：'1 2 x' 不是 6 个数；改用 0 0 0 0 0 0"),
    ("no joint of model m named 'j'; there are: none", "没有名为 'j' 的模型 m 的关节；有：无"),
    ("model m (1 links, 0 joints)", "模型 m（1 个 link，0 个关节）"),
    ("target a: left out: a.cpp includes <gazebo/gazebo.hh>, and the C++ API of Gazebo is not here",
     "target a: 略去：a.cpp 包含 <gazebo/gazebo.hh>，而这里没有 Gazebo 的 C++ API"),
    ("3 packages: to be installed: a b", "3 个包：需要安装：a b"),
    ("a/package.xml: The manifest contains invalid XML: not well-formed (invalid token): line 1, "
     "column 28; mend it first, no package is built before",
     "a/package.xml：不是有效的 XML：格式不正确（无效符号）: 第 1 行第 28 列；请先改好它，"
     "在那之前一个包也不编译"),
    ("line 3", "第 3 行"),
    ("not well-formed (invalid token): line 1, column 28",
     "格式不正确（无效符号）: 第 1 行第 28 列"),
    ("mapping 12.0 s | way-point 3/5, 1.2 m off | 3.0 m driven | touched 0 | real time x1.00",
     "mapping 12.0 s | 路点 3/5，还差 1.2 m | 已行驶 3.0 m | 碰撞 0 次 | 真实时间的 1.00 倍"),
    ("gz: Unable to find file 'a.sdf'", "gz: 找不到文件 'a.sdf'"),
    ("FAIL  time between two messages, the worst: 0 s, wanted 0.5 s ± 0.01 s",
     "未过  两条消息之间的时间，最差的: 0 s，要求 0.5 s ± 0.01 s"),
    ("pass  commanded speed (after rosparam set /a/speed 2): 2 m/s, wanted at least 1 m/s",
     "通过  速度指令（rosparam set /a/speed 2 之后）: 2 m/s，要求至少 1 m/s"),
    ("3.4 cm off the line (3 cm or less costs nothing)", "偏离线 3.4 厘米（3 厘米以内不扣分）"),
    ("check: x: no such file or package (did you mean y?); try `rospack list`, or give a path",
     "check: x: 没有这个文件或包（是不是 y？）；试试 `rospack list`，或给出路径"),
    ("1 package: installing a b", "1 个包：正在安装 a b"),
    ("a: not valid YAML: expected '<document start>', but found '<scalar>' in "
     '"<unicode string>", '"line 3, column 5: b ^",
     "a：不是有效的 YAML：第 3 行第 5 列：应为“<document start>”，却是“<scalar>”：b ^")])
def test_the_shipped_catalogue_has(english, chinese):
    assert read_catalogue("zh_CN").translate(english) == chinese


@pytest.mark.parametrize("text", [
    "GetModelState: model does not exist", "DeleteModel: model does not exist"])
def test_upstreams_answers_stay_whole(text):
    assert read_catalogue("zh_CN").translate(f"[ERROR] [1.2, 3.4]: {text}").endswith(text)


def test_what_is_too_deep_stays():
    said = "mark: missing key 'b'; there are: c d"
    assert read_catalogue("zh_CN")._message(said, 0) is None


def test_a_heading_is_translated_as_one_alone(monkeypatch):
    monkeypatch.setenv("LC_ALL", "C.UTF-8")
    monkeypatch.setenv("LANGUAGE", "zh_CN")
    assert (heading("laps"), heading("m"), translated("laps")) == ("圈数", "m", "laps")
    monkeypatch.setenv("LANGUAGE", "en")
    assert heading("laps") == "laps"


@pytest.mark.parametrize(("text", "cells", "kept"), [
    ("lap 1", 5, "lap 1"), ("lap 1", 4, "lap "), ("圈数 1", 6, "圈数 1"), ("圈数 1", 3, "圈"),
    ("圈数", 0, "")])
def test_chinese_takes_two_cells(text, cells, kept):
    assert cut(text, cells) == kept and width(kept) <= cells


def test_data_with_many_colons_are_written_as_they_are():
    data = "; ".join(f"{at}: the line" for at in range(2000))
    assert CATALOGUE.translate(data) == data


def test_a_stream_is_otherwise_what_it_was():
    under = io.StringIO()
    stream = TranslatedStream(under, CATALOGUE.translate)
    print("the line is lost", 3, sep=": ", file=stream)
    stream.writelines(["no such file", "\n"])
    assert under.getvalue() == "线丢了: 3\n没有这个文件\n"
    assert stream.write("no such file") == 12 and stream.isatty() is False


def test_ctrl_c_while_a_program_of_ours_imports_is_no_traceback(tmp_path):
    (tmp_path / "rospy.py").write_text("import os, signal, time\nos.kill(os.getpid(), "
                                       "signal.SIGINT)\ntime.sleep(60)\n", encoding="utf-8")
    places = [str(tmp_path), str(START), str(SOURCE)]
    def typed(*words):
        return subprocess.run(
            [sys.executable, *words], text=True, capture_output=True, check=False, timeout=120,
            env=os.environ | {"PYTHONPATH": os.pathsep.join(places)})

    ours = typed(SOURCE.parents[2] / "learning_topic/scripts/06follower_pid.py")
    assert (ours.returncode, ours.stderr) == (-2, "")
    assert "KeyboardInterrupt" in typed("-c", "import rospy").stderr


@pytest.mark.parametrize(("more", "said"), [
    ({"LANG": "zh_CN.UTF-8"}, "用法"), ({"LC_ALL": "C.UTF-8", "LANGUAGE": "zh"}, "用法"),
    ({"LANG": "C.UTF-8"}, "usage"),
    ({"LANG": "zh_CN.UTF-8", "PYTHONIOENCODING": "ascii"}, "usage")])
def test_a_program_of_ours_starts_in_the_language_of_the_locale(more, said):
    base = {name: value for name, value in os.environ.items()
            if name not in ("LANG", "LANGUAGE", "LC_ALL", "LC_MESSAGES")}
    done = subprocess.run(
        [sys.executable, SOURCE.parents[3] / "scripts/terminal_texts.py", "--help"], text=True,
        encoding="utf-8", capture_output=True, check=True,
        env={**base, "PYTHONPATH": f"{START}:{SOURCE}:{base.get('PYTHONPATH', '')}", **more})
    assert done.stdout.startswith(said), done.stdout


def test_a_line_of_separators_takes_linear_time():
    sentence = Sentence("{0} seed {1}: {2}, {3} of {4} laps, {5} m/s, RMS {6} cm{7} (x{8})", "")
    began = time.process_time()
    assert sentence.values(" seed " + ": ,  of  laps,  m/s, RMS  cm" * 40) is None
    assert time.process_time() - began < 1  # 10 s with a regular expression
    assert sentence.values("a seed b: c, d, e of f laps, g m/s, RMS h cmi (xj)") == dict(
        enumerate(("a", "b", "c", "d, e", "f", "g", "h", "i", "j")))


def test_a_catalogue_is_read_once():
    assert read_catalogue("zh_CN") is read_catalogue("zh_CN")


@pytest.mark.parametrize(("english", "part"), [
    ("A simulator runs already on this master (world course, started 3 min ago). End it with "
     "Ctrl-C in its terminal, then type this again.", "世界 course，3 分钟前启动"),
    ("rviz has no window here; the page in the browser does its work, tab RViz. Type: roslaunch",
     "浏览器页面的“RViz”标签页"),
    ("line 1: it ends as lines do on Windows, so that no interpreter is found; type: sed x",
     "行尾是 Windows 的换行符，因此找不到解释器；请输入：sed x"),
    ("the program ended (exit code 1): ModuleNotFoundError: No module named 'x'",
     "程序结束了（退出码 1）: ModuleNotFoundError: No module named 'x'"),
    ("gz model: what is to be done with the model? Type: gz model --help",
     "gz model: 要对模型做什么？"),
    ("spawn_model: error: one of the arguments -file -param is required",
     "必须给出这些参数之一：-file -param"),
    ("make_track: error: argument --random: 'x' must be a whole number from 0",
     "make_track: 错误：参数 --random：'x' 必须是不小于 0 的整数"),
    ("spawn_model: error: argument -x: invalid float value: 'abc'", "参数 -x：'abc' 不是数字"),
    ("autorace: no mission 'foo' (MISSION=); there are: all",
     "没有任务 'foo'（MISSION=）；可用的有"),
    ("no turtle: service [/spawn] responded with an error: b'service cannot process request: A "
     "turtle named [turtle2] already exists': is there a turtle2 already?",
     "没有生成海龟：服务 [/spawn] 拒绝了：A turtle named [turtle2] already exists"),
    ('not yet: "a" passed to lookupTransform argument target_frame does not exist. ',
     '还没有：没有坐标系 "a"（lookupTransform 的参数 target_frame）')])
def test_no_english_word_is_left_within_a_translated_line(english, part):
    assert part in read_catalogue("zh_CN").translate(english)
