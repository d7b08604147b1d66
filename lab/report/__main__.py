"""dof-report: measures error and run time of every kind of system that makes depth of field."""
import argparse
import importlib.util
import os
import pathlib
import pkgutil
import re
import signal
import sys
import time

import rows
from steps import Failure, Runner, StepList, TimeLeft, UsageError, write_file
from systems import Budgets, open_scene, plan_rows

ABOUT = "Measures the error and the run time of every kind of system that makes depth of field, on your scene\n\n"
EXAMPLES = """
Examples:
  Measure small pictures of one scene, in under a minute:
      dof-report fence --quick -o report
  Measure your own views, which have a reference and a camera.json:
      dof-report shot -o report
"""
QUICK = Budgets("160x90", 1024, samples=(4, 16), lens_views=(4, 64), rays=(4, 16, 64))


class Help(argparse.HelpFormatter):
    def _format_action_invocation(self, action):
        required = "REQUIRED" if action.required and action.option_strings else ""
        return " ".join(filter(None, [", ".join(action.option_strings), action.metavar, required]))


class Parser(argparse.ArgumentParser):
    def error(self, message):
        raise UsageError(message + " (see --help)")

    def format_help(self):
        """The form of the other tools' help."""
        text = super().format_help().replace("usage:", "Usage:").replace("positional arguments:", "Positionals:")
        return ABOUT + text.replace("options:", "Options:") + EXAMPLES


def like(pattern, what, convert=str):
    def read(text):
        if not re.fullmatch(pattern, text):
            raise argparse.ArgumentTypeError(f"must be {what}, not '{text}'")
        return convert(text)
    return read


def options(words):
    parser = Parser("dof-report", "dof-report [OPTIONS] [SCENE...]", add_help=False, allow_abbrev=False,
                    formatter_class=lambda prog: Help(prog, max_help_position=30, width=120))
    add = parser.add_argument
    add("scenes", nargs="*", metavar="SCENE", help="Built-in scenes of dof-trace, or folders of ready-made views with "
        "a reference and a camera.json (default: fence grass lamps)")
    add("-h", "--help", action="help", help="Print this help message and exit")
    add("-o", "--output", required=True, metavar="DIR",
        help="Folder for the report; what was measured there before is not measured again")
    add("--quick", action="store_true", help="Use small pictures, few budgets and one variant of each method")
    add("--size", type=like("[1-9][0-9]{0,4}x[1-9][0-9]{0,4}", "WIDTHxHEIGHT (e.g. 640x360)"), metavar="WxH",
        help="Size of the built-in scenes, in pixels (default: 640x360, with --quick 160x90)")
    add("--reference", type=like("[1-9][0-9]{0,5}", "1 to 999999", int), metavar="SPP",
        help="Rays per pixel of the reference of the built-in scenes (default: 4096, with --quick 1024)")
    add("--runs", type=like("[1-9][0-9]{0,2}", "1 to 999", int), metavar="N", help="Number of runs whose median time "
        "is taken; long steps are run fewer times (default: 3, with --quick 1)")
    add("--version", action="version", help="Display program version information and exit",
        version="dof-report (sparselens) " + pkgutil.get_data("rows", "version").decode().strip())
    add("-v", "--verbose", action="store_true", help="Report on stderr what was found and done")
    add("--threads", type=like("[0-9]{1,4}", "0 to 9999", int), default=os.environ.get("CUE_THREADS") or "0",
        metavar="N (Env:CUE_THREADS)", help="Number of threads; 0: all that the process may use (default: 0)")
    add("--max-memory", type=like("(?i)[0-9.]+ *([kmgt]i?)?b?", "a size (e.g. 4GB)"), metavar="SIZE",
        help="Memory limit of each tool for reading a file, e.g. 4GB (default: that of the tool)")
    return parser.parse_intermixed_args(words)


def machine(threads):
    names = re.findall("model name\\s*: (.*)", pathlib.Path("/proc/cpuinfo").read_text()) or ["unknown processor"]
    return f"{names[0]}, threads: {threads or len(os.sched_getaffinity(0))}, {time.strftime('%Y-%m-%d', time.gmtime())}"


def report(words):
    chosen = options(words)
    lacking = [name for name in ["matplotlib", "numpy", "OpenImageIO"] if importlib.util.find_spec(name) is None]
    if lacking:
        raise Failure(f"Python's {', '.join(lacking)} is not installed: tools/install-deps.sh report")
    budgets, steps = QUICK if chosen.quick else Budgets(), StepList()
    budgets.size, budgets.reference = chosen.size or budgets.size, chosen.reference or budgets.reference
    runner = Runner(os.path.dirname(os.path.realpath(sys.argv[0])), os.path.abspath(chosen.output), chosen.threads,
                    chosen.runs or (1 if chosen.quick else 3), chosen.max_memory, verbose=chosen.verbose)
    load_before, scenes = os.getloadavg()[0], {}
    for name in chosen.scenes or ["fence", "grass", "lamps"]:
        scene = open_scene(name, budgets, runner.tools, steps)
        if scene.name in scenes:
            raise UsageError(f"{name}: another scene is called {scene.name} too")
        scene.reference()
        scenes[scene.name] = scene, plan_rows(scene, budgets, chosen.quick, steps)
    runner.run_all(steps.values())
    facts = [machine(chosen.threads), " ".join(["dof-report", *words]),
             f"load before the first step: {load_before:.2f}, after the last: {os.getloadavg()[0]:.2f}"]
    print("\n".join(facts) + "\n", flush=True)
    # These need much memory, which would count as that of the tools.
    from measure import measure_rows
    from page import page_as_html, scene_of_page
    of_page = []
    for scene, of_scene in scenes.values():
        of_page.append(scene_of_page(runner.folder, of_scene, measure_rows(scene, of_scene, runner)))
        print(rows.summary(of_scene), flush=True)
    write_file(runner.path("report.csv"), rows.as_csv([of_scene for _, of_scene in scenes.values()]))
    write_file(runner.path("index.html"), page_as_html(facts, of_page))


def main():
    signal.signal(signal.SIGINT, signal.SIG_DFL)
    try:
        return report(sys.argv[1:])
    except (Failure, UsageError) as error:
        text, code = error.args[0], 2 if isinstance(error, UsageError) else 1
    except OSError as error:
        text, code = f"{error.filename or 'standard output'}: {error.strerror}", 1
    TimeLeft([]).show()
    print(f"dof-report: {text}", file=sys.stderr)
    return code


sys.exit(main())
