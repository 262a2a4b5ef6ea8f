"""python3 -m relume.laboratory COMMAND"""

import argparse
import difflib
import signal
import sys
from typing import Callable, Optional, Sequence

import relume

try:
    import jinja2 as _
    import matplotlib as _
except ImportError as missing:
    sys.exit(f"laboratory: {missing}; it needs matplotlib and Jinja2: install python3-matplotlib and python3-jinja2")

from . import factorization, layouts, paper_figures, sources, tables
from .evaluation import Evaluation
from .program import Program
from .scenes import FULL, QUICK
from .store import LabError, Path, log

SECTIONS = {  # in the report's order
    "table-1": tables.table_1,
    "table-2": tables.table_2,
    "figure-2": paper_figures.figure_2,
    "figure-3": paper_figures.figure_3,
    "figure-4": paper_figures.figure_4,
    "figure-5": paper_figures.figure_5,
    "scenes": paper_figures.scenes,
    "sources": sources.sources,
    "refinement": sources.refinement,
    "layouts": tables.layouts,
}


def _named(text: str) -> tuple[str, Path]:
    """From NAME=FILE, or FILE, named after itself. Names may have a = of their own."""
    name, equals, file = text.rpartition("=")
    if not Path(file).is_file():
        raise argparse.ArgumentTypeError(f"{file}: there is no such file")
    return (name if equals else Path(file).stem), Path(file)


def _numbers(kind: type, low: float, high: float) -> Callable[[str], list]:
    def parse(text: str) -> list:
        values = [kind(part) for part in text.split(",")]
        if not all(low <= value <= high for value in values):
            raise argparse.ArgumentTypeError(f"expected {low:g} to {high:g}, found {text}")
        return values
    return parse


def _number(low: int, high: int) -> Callable[[str], int]:
    def parse(text: str) -> int:
        if not low <= int(text) <= high:
            raise argparse.ArgumentTypeError(f"expected {low} to {high}, found {text}")
        return int(text)
    return parse


def _sections(text: str) -> list[str]:
    names = text.split(",")
    for name in names:
        if name not in SECTIONS:
            near = difflib.get_close_matches(name, SECTIONS, 1, 0)
            raise argparse.ArgumentTypeError(f"there is no section \"{name}\"; did you mean \"{near[0]}\"?")
    return names


def _folder(text: str) -> Path:
    if not Path(text).is_dir():
        raise argparse.ArgumentTypeError(f"{text} is no folder")
    return Path(text)


def _svg(text: str) -> Path:
    if Path(text).suffix != ".svg":
        raise argparse.ArgumentTypeError(f"expected a name ending in .svg, found \"{text}\"")
    return Path(text)


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(prog="python3 -m relume.laboratory", description="Measures Relume.")
    commands = parser.add_subparsers(dest="command", required=True, metavar="COMMAND")
    light = argparse.ArgumentParser(add_help=False)
    light.add_argument("-e", "--environment", type=_named, action="append", default=[], metavar="[NAME=]FILE",
                       help="light (.exr, .hdr); may be repeated")

    command = commands.add_parser(
        "evaluate", help="measure what the paper measured, and write a report beside its numbers",
        formatter_class=argparse.RawDescriptionHelpFormatter,
        epilog="sections:\n" + "".join(f"  {name:<11} {make.__doc__}\n" for name, make in SECTIONS.items()) +
        "\nResults are kept in FOLDER as they are made: after Ctrl-C the same command goes on from there,\n"
        "and a later one does nothing twice. docs/evaluation.md says what is measured.")
    command.add_argument("-o", "--output", type=Path, required=True, metavar="FOLDER",
                         help="where report.html and all else is written to")
    command.add_argument("--data", type=_folder, metavar="FOLDER",
                         help="folder with meshes/{buddha,dragon,lucy}*.obj and "
                         "environments/{grace,stpeters,rnl,uffizi}*.hdr; what is missing is named and skipped")
    command.add_argument("--quick", action="store_true",
                         help="in minutes: smaller scenes and images; what is missing is replaced by what is "
                         "installed; the report says where")
    command.add_argument("--only", type=_sections, action="extend", default=[], metavar="SECTION,…",
                         help="sections to run, all if none is named; the report has others that are done, too")
    command.add_argument("--device", default="", metavar="SELECT",
                         help="a device's index, name or UUID, as relume devices lists them")

    command = commands.add_parser("factorization", parents=[light], help="compare the ways to factor a BRDF",
                                  description="Writes factorization.csv and figures, prints tables in Markdown.")
    command.add_argument("materials", nargs="*", metavar="MATERIAL", help="further materials, as of relume bake")
    command.add_argument("--only", action="store_true", help="only these, not the usual ones")
    command.add_argument("--sets", action="store_true",
                         help="price sets instead: print the errors of each material alone and in sets of 2, 4, 8 …")
    command.add_argument("-o", "--output", type=Path, default=Path("."), metavar="FOLDER", help="where to write to (.)")
    command.add_argument("--sizes", type=_numbers(int, 4, 64), default="16,32,48,64", metavar="S,S,…",
                         help="sides of maps (%(default)s)")
    command.add_argument("--orientations", type=_number(1, 100000), default=240, metavar="COUNT",
                         help="orientations of the light (%(default)s)")

    command = commands.add_parser("layouts", parents=[light],
                                  help="measure what layouts of transport lose for their bytes",
                                  description="Writes layouts.csv and figures, prints tables in Markdown.")
    command.add_argument("bakes", nargs="+", type=_named, metavar="[NAME=]FILE",
                         help="bakes in rows of many coefficients (.relume)")
    command.add_argument("-o", "--output", type=Path, default=Path("."), metavar="FOLDER", help="where to write to (.)")
    command.add_argument("--rows", type=_numbers(int, 1, 24576), default="24,48,96,192", metavar="N,N,…",
                         help="most coefficients of a row, in rows (%(default)s)")
    command.add_argument("--budgets", type=_numbers(float, 1, 1e6), default="50,100,200,400,800,1600",
                         metavar="B,B,…", help="bytes a vertex of bases (%(default)s)")
    command.add_argument("--width", type=_number(16, 4096), default=320, help="of images (%(default)s)")
    command.add_argument("--height", type=_number(16, 4096), default=240, help="of images (%(default)s)")

    command = commands.add_parser("brdf", parents=[light], help="draw how far the terms of a BRDF are from it")
    command.add_argument("material", metavar="MATERIAL", help="as of relume bake")
    command.add_argument("-K", "--terms", type=_number(1, 32), default=16, metavar="K", help="terms (%(default)s)")
    command.add_argument("--factorization", default="environment", metavar="METHOD",
                         help="as of relume bake (%(default)s)")
    command.add_argument("--size", type=_number(4, 64), default=48, metavar="S", help="side of a map (%(default)s)")
    command.add_argument("--plot", type=_svg, metavar="SVG", help="errors over the number of terms")
    command.add_argument("--slice", type=_svg, metavar="SVG",
                         help="lobes in the plane of incidence: the BRDF solid, its terms dashed")
    return parser


def _run(arguments: argparse.Namespace, parser: argparse.ArgumentParser) -> int:
    """Returns the exit code."""
    if arguments.command == "evaluate":
        evaluation = Evaluation(arguments.output, arguments.data, QUICK if arguments.quick else FULL, arguments.device)
        if not evaluation.run(SECTIONS, arguments.only):
            raise LabError("some steps failed: the report says which, and why; the same command tries them again")
        return 0
    lights = dict(arguments.environment)
    if arguments.command == "brdf":
        if not arguments.plot and not arguments.slice:
            parser.error("brdf: name a file to draw to, by --plot or --slice")
        factorization.draw_brdf(arguments.material, lights, arguments.terms, arguments.factorization, arguments.size,
                                arguments.plot, arguments.slice)
        return 0
    if not lights:
        parser.error(f"{arguments.command}: name an environment, by -e")
    if arguments.command == "layouts":
        options = layouts.Options(lights, arguments.rows, arguments.budgets, (arguments.width, arguments.height))
        print(layouts.run(arguments.output, dict(arguments.bakes), options, Program()), end="")
        return 0
    if arguments.only and not arguments.materials:
        parser.error("factorization --only: give a MATERIAL")
    usual = factorization.SET_MEMBERS if arguments.sets else factorization.MATERIALS
    materials = {**({} if arguments.only else usual), **{text: text for text in arguments.materials}}
    work = factorization.price_sets if arguments.sets else factorization.run
    options = factorization.Options(lights, arguments.sizes, arguments.orientations)
    print(work(arguments.output, materials, options), end="")
    return 0


def main(arguments: Optional[Sequence[str]] = None) -> int:
    parser = _parser()
    signal.signal(signal.SIGTERM, signal.default_int_handler)  # stops as Ctrl-C does
    try:
        return _run(parser.parse_args(arguments), parser)
    except KeyboardInterrupt:
        log("stopped; the same command goes on from there")
        return 130
    except relume.NoDeviceError as failure:
        log(str(failure))
        return 4
    except (LabError, relume.Error, OSError) as failure:
        log(str(failure))
        return 2 if isinstance(failure, relume.UsageError) else 1


if __name__ == "__main__":
    sys.exit(main())
