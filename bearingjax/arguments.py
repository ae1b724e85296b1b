"""What may be written on the command line."""

import argparse
from pathlib import Path


def parser() -> argparse.ArgumentParser:
    """Of the command line, without what its commands do."""
    from importlib.metadata import version

    top = argparse.ArgumentParser(
        prog="bearingjax", description="Rolling-bearing mechanics."
    )
    top.add_argument("--version", action="version", version=version("bearingjax"))
    commands = top.add_subparsers(dest="command", required=True, metavar="COMMAND")
    solve = commands.add_parser(
        "solve",
        help="where the rings go under load",
        description="Solve the bearing of a scene file and print a report.",
        epilog="Exit status: 0 solved, 2 bad input, 3 not solved.",
    )
    _add_common(solve)
    solve.add_argument(
        "--plot", metavar="OUT", type=Path, help="write a picture (.png, .pdf, .svg)"
    )
    solve.add_argument(
        "--report",
        metavar="OUT",
        type=Path,
        help="write a report that stands alone (.html), with inputs and pictures",
    )
    sweep = commands.add_parser(
        "sweep",
        help="many cases: loads, displacements, speeds, designs",
        description="Solve the [cases] of a scene file.",
        epilog="Exit status: 0 all solved, 2 bad input, 3 some not solved (the table"
        " holds a result for each case), 130 interrupted (what is solved is kept).",
    )
    _add_common(sweep)
    sweep.add_argument(
        "--table",
        metavar="OUT",
        type=Path,
        help="write a row per case (.csv, .parquet, .xlsx)",
    )
    sweep.add_argument(
        "--resume",
        action="store_true",
        help="solve only the cases that the table lacks, after an interruption",
    )
    sweep.add_argument(
        "--report",
        metavar="OUT",
        type=Path,
        help="write a report that stands alone (.html), with inputs and cases",
    )
    sweep.add_argument("--quiet", action="store_true", help="no progress bar")
    sweep.add_argument(
        "--devices",
        metavar="N",
        type=int,
        default=None,
        help="parts of the processor to spread the cases over; default: all its cores",
    )
    optimise = commands.add_parser(
        "optimise",
        help="the free numbers of a design that make a measure least",
        description="Optimise the bearing of a scene file, as its [optimise] says, over"
        " its [cases].",
        epilog="Exit status: 0 optimised, 2 bad input, 3 not solved or not converged.",
    )
    _add_common(optimise)
    optimise.add_argument(
        "--plot", metavar="OUT", type=Path, help="write a picture (.png, .pdf, .svg)"
    )
    optimise.add_argument("--progress", action="store_true", help="show progress")
    life = commands.add_parser(
        "life",
        help="rating life, of one load or of a load spectrum",
        description="Rating life of the bearing of a scene file by ISO 281 and ISO/TS"
        " 16281, as its [life] says, under its load or, if it has [cases], under all of"
        " them, whose damage adds up over their hours.",
        epilog="Exit status: 0 solved, 2 bad input, 3 not solved.",
    )
    _add_common(life)
    life.add_argument(
        "--table",
        metavar="OUT",
        type=Path,
        help="write a row per case (.csv, .parquet)",
    )
    life.add_argument("--quiet", action="store_true", help="no progress bar")
    contact = commands.add_parser(
        "contact",
        help="one roller on one raceway, its ends included",
        description="Solve the contact of one roller and one raceway, both elastic"
        " half-spaces, cell by cell; beside it what independent slices give.",
        epilog="Exit status: 0 solved, 2 bad input, 3 not solved.",
    )
    _add_common(contact)
    contact.add_argument(
        "--roller",
        type=int,
        help="of a bearing's scene; default: the one with the largest load",
    )
    contact.add_argument(
        "--raceway", choices=("inner", "outer"), help="likewise; default: inner"
    )
    contact.add_argument(
        "--free-ends",
        action="store_true",
        help="likewise: the roller's end faces bear no stress",
    )
    contact.add_argument(
        "--plot", metavar="OUT", type=Path, help="write a picture (.png, .pdf, .svg)"
    )
    skid = commands.add_parser(
        "skid",
        help="balls and rollers that skid: over time, or in the end",
        description="How the balls or rollers of a bearing move with its cage in its"
        " [lubricant], over the time of its [dynamics], or in the end.",
        epilog="Exit status: 0 solved, 2 bad input, 3 not solved.",
    )
    _add_common(skid)
    skid.add_argument(
        "--steady", action="store_true", help="the end state, without the way there"
    )
    skid.add_argument(
        "--table",
        metavar="OUT",
        type=Path,
        help="write a row per time, or per place along the orbit (.csv, .parquet,"
        " .xlsx)",
    )
    skid.add_argument(
        "--plot", metavar="OUT", type=Path, help="write a picture (.png, .pdf, .svg)"
    )
    skid.add_argument("--quiet", action="store_true", help="no progress bar")
    rotor = commands.add_parser(
        "rotor",
        help="a shaft on its bearings: modes, critical speeds, vibration",
        description="Static equilibrium of the [rotor] of a scene on its bearings,"
        " modes at its speed, critical speeds; and if the scene has these tables, the"
        " [rotor.campbell] diagram, the [rotor.response] to unbalance or a shaking"
        " base, and the motion in time of [rotor.transient].",
        epilog="Exit status: 0 solved, 2 bad input, 3 not solved, or only in part.",
    )
    _add_common(rotor)
    rotor.add_argument(
        "--table",
        metavar="OUT",
        type=Path,
        help="write a row per point of the response, or per time of the motion in time"
        " (.csv, .parquet, .xlsx)",
    )
    rotor.add_argument(
        "--series",
        choices=("response", "transient"),
        help="which of them --table has, if the scene has both",
    )
    rotor.add_argument(
        "--plot", metavar="OUT", type=Path, help="write a picture (.png, .pdf, .svg)"
    )
    rotor.add_argument("--quiet", action="store_true", help="no progress")
    noise = commands.add_parser(
        "noise",
        help="vibration and noise from form errors",
        description="The vibration of a bearing with the form errors of its"
        " [deviations] on the rig of its [vibration]: levels, bands, lines and what"
        " makes them.",
        epilog="Exit status: 0 solved, 2 bad input, 3 not solved.",
    )
    _add_common(noise)
    noise.add_argument(
        "--monte-carlo",
        metavar="N",
        type=int,
        help="also N random bearings, as [vibration.tolerance] has them scatter",
    )
    noise.add_argument(
        "--wav",
        metavar="OUT",
        type=Path,
        help="write the acceleration along the sensor as sound (.wav)",
    )
    noise.add_argument(
        "--table",
        metavar="OUT",
        type=Path,
        help="write a row per time (.csv, .parquet, .xlsx)",
    )
    noise.add_argument(
        "--plot", metavar="OUT", type=Path, help="write a picture (.png, .pdf, .svg)"
    )
    noise.add_argument("--quiet", action="store_true", help="no progress")
    _add_catalogue(commands)
    return top


def _add_catalogue(commands) -> None:
    """Commands that list, and solve nothing."""
    catalogue = commands.add_parser(
        "catalogue",
        help="bearings by their designation",
        description="List the bearings of the catalogue, or say all that is known of"
        ' some: "6205", "NJ 209 ECP/C3".',
        epilog="Exit status: 0, or 2 for bad input.",
    )
    catalogue.add_argument(
        "designation", metavar="DESIGNATION", nargs="*", help="default: all that fit"
    )
    catalogue.add_argument("--type", help="such as deep_groove_ball")
    catalogue.add_argument(
        "--bore", metavar="RANGE", help='"25 mm", "20 mm:40 mm", ":40 mm"'
    )
    catalogue.add_argument("--outside", metavar="RANGE", help="outside diameter")
    catalogue.add_argument(
        "--min-capacity",
        dest="capacity",
        metavar="FORCE",
        help='least dynamic capacity, "10 kN", or a range "10 kN:20 kN"',
    )
    catalogue.add_argument(
        "--json", metavar="OUT", type=Path, help="write numbers in SI"
    )
    catalogue.add_argument(
        "--plot",
        metavar="OUT",
        type=Path,
        help="draw sections of the bearings that are named (.png, .pdf, .svg)",
    )
    new = commands.add_parser(
        "new",
        help="a scene of a bearing of the catalogue",
        description="Print a scene of a bearing under a tenth of its capacity:"
        " bearingjax new 6205 > my.toml",
        epilog="Exit status: 0, or 2 for bad input.",
    )
    new.add_argument("designation", metavar="DESIGNATION", nargs="+")
    examples = commands.add_parser(
        "examples",
        help="the scenes that come with the package",
        description="List the shipped scenes, or print one.",
        epilog="Exit status: 0, or 2 for bad input.",
    )
    examples.add_argument("name", metavar="NAME", nargs="?")


def _add_common(command):
    command.add_argument("scene", metavar="SCENE", help=".toml file or a shipped scene")
    command.add_argument("--json", metavar="OUT", type=Path, help="write numbers in SI")
    command.add_argument(
        "--set",
        metavar="KEY=VALUE",
        action="append",
        default=[],
        help='change the scene, such as "operating.load.Fz=-6 kN"; may be repeated',
    )
