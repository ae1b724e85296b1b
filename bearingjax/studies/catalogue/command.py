"""`bearingjax catalogue`, `new` and `examples`."""

from argparse import Namespace

from ..outputs import check_outputs, save, write_outputs
from ..status import BAD_INPUT, SOLVED


def list_bearings(options: Namespace) -> int:
    """List the bearings of the catalogue, or say all that is known of some: "6205", "NJ
    209 ECP/C3"."""
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


def print_new_scene(options: Namespace) -> None:
    """Print a scene of a bearing under a part of its capacity: bearingjax new 6205 >
    my.toml. Of a bearing that the catalogue does not list give type, sizes and ratings;
    its inner geometry is then an estimate. `bearingjax new shaft` prints a commented
    scene of a gearbox."""
    from ...catalogue.estimated_entry import SIZES, estimated_entry
    from ...files import SceneError
    from ..bearing.catalogue_keys import listed_bearing
    from .catalogue_report import new_scene

    given = {name: getattr(options, name) for name in SIZES}
    name = " ".join(options.designation)
    others = [*given.values(), options.contact_angle]
    if name == "shaft":
        return print_example(Namespace(name="shaft_gearbox"))
    if options.type is None:
        if not name:
            raise SceneError("new: give a designation, or --type and sizes")
        if any(value is not None for value in others):
            raise SceneError(f"new {name}: sizes and ratings go with --type")
        entry = listed_bearing(name)
    elif name:
        raise SceneError(f"new {name}: give a designation or --type, not both")
    else:
        entry = estimated_entry(options.type, given, options.contact_angle)
    print(new_scene(entry), end="", flush=True)


def print_example(options: Namespace) -> None:
    """List the shipped scenes, or print one."""
    from ...files import SceneError, shipped_scenes
    from ...files.table import not_among
    from .catalogue_report import scene_list

    scenes = shipped_scenes()
    if options.name is None:
        print(scene_list(), flush=True)
    elif options.name in scenes:
        print(scenes[options.name].read_text(encoding="utf-8"), end="", flush=True)
    else:
        raise SceneError(f"examples: {not_among(options.name, tuple(scenes))}")
