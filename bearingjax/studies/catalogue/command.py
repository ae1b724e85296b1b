"""`bearingjax catalogue`."""

from argparse import ArgumentParser, Namespace

from ..options import Commands, add_drawing, add_json, add_plot
from ..outputs import check_outputs, save, write_outputs
from ..status import BAD_INPUT, SOLVED


def add(commands: Commands) -> ArgumentParser:
    """Add the command and its options; return its parser."""
    command = commands.add_parser(
        "catalogue",
        help="bearings by their designation",
        description="List the bearings of the catalogue, or say all that is known of"
        ' some: "6205", "NJ 209 ECP/C3".',
        epilog="Exit status: 0, or 2 for bad input.",
    )
    command.add_argument(
        "designation", metavar="DESIGNATION", nargs="*", help="default: all that fit"
    )
    command.add_argument("--type", help="such as deep_groove_ball")
    command.add_argument(
        "--bore", metavar="RANGE", help='"25 mm", "20 mm:40 mm", ":40 mm"'
    )
    command.add_argument("--outside", metavar="RANGE", help="outside diameter")
    command.add_argument(
        "--min-capacity",
        dest="capacity",
        metavar="FORCE",
        help='least dynamic capacity, "10 kN", or a range "10 kN:20 kN"',
    )
    add_json(command)
    add_plot(command, "draw sections of the bearings that are named")
    add_drawing(command)
    return command


def run(options: Namespace) -> int:
    """List bearings of the catalogue."""
    from ...catalogue.entry import bearing_of_entry, catalogue_entries
    from ...files import SceneError
    from ...report.json_output import write_numbers
    from ..bearing.catalogue_keys import listed_bearing
    from .catalogue_report import (
        catalogue_as_dict,
        catalogue_details,
        catalogue_table,
        catalogue_title,
        select,
    )

    named = tuple(listed_bearing(name) for name in options.designation)
    if options.plot is not None and not named:
        raise SceneError("--plot draws the bearings that are named; name some")
    if options.drawing is not None and len(named) != 1:
        raise SceneError("--drawing draws one bearing; name one")
    check_outputs(options, inputs=[])
    chosen = select(
        named or catalogue_entries(),
        options.type,
        options.bore,
        options.outside,
        options.capacity,
    )

    def draw(path):
        from ...plot import cross_sections

        titles = [
            f"{e.designation}, inner geometry {e.geometry}; ring bodies schematic"
            for e in chosen
        ]
        bearings = list(map(bearing_of_entry, chosen))
        save(cross_sections(bearings, titles, chosen), path)

    def draw_all_of_it(path):
        from ...plot import drawing

        one = chosen[0]
        save(drawing(bearing_of_entry(one), catalogue_title(one), one), path)

    outputs = [
        (options.json, lambda path: write_numbers(path, catalogue_as_dict(chosen))),
        (options.plot, draw if chosen else None),
        (options.drawing, draw_all_of_it if chosen else None),
    ]
    failed = write_outputs(outputs)
    if named and chosen:
        print("\n\n".join(catalogue_details(entry) for entry in chosen), flush=True)
    else:
        print(catalogue_table(chosen), flush=True)
    return BAD_INPUT if failed else SOLVED
