"""`bearingjax new`."""

from argparse import ArgumentParser, Namespace

from ..options import Commands
from ..status import SOLVED


def add(commands: Commands) -> ArgumentParser:
    """Add the command and its options; return its parser."""
    command = commands.add_parser(
        "new",
        help="a scene of a bearing of the catalogue or another, or of shafts",
        description="Print a scene of a bearing under a part of its capacity:"
        " bearingjax new 6205 > my.toml. Of a bearing that the catalogue does not list"
        " give type, sizes and ratings; its inner geometry is then an estimate."
        " `bearingjax new shaft` prints a commented scene of a gearbox.",
        epilog="Exit status: 0, or 2 for bad input.",
    )
    command.add_argument("designation", metavar="DESIGNATION", nargs="*")
    command.add_argument("--type", help="of an unlisted one, such as deep_groove_ball")
    command.add_argument("--bore", metavar="LENGTH", help='d, "85 mm"')
    command.add_argument("--outside", metavar="LENGTH", help="outside diameter D")
    command.add_argument(
        "--width",
        metavar="LENGTH",
        help="B; T of tapered rollers, H of thrust bearings",
    )
    command.add_argument("--capacity", metavar="FORCE", help='C, "87.1 kN"')
    command.add_argument("--static-capacity", metavar="FORCE", help="C0")
    command.add_argument(
        "--contact-angle", metavar="ANGLE", help='"40 deg"; default: estimated too'
    )
    return command


def run(options: Namespace) -> int:
    """Print a scene of a bearing, of the catalogue or estimated, or of shafts."""
    from ...catalogue.estimated_entry import SIZES, estimated_entry
    from ...files import SceneError, shipped_scenes
    from ..bearing.catalogue_keys import listed_bearing
    from .catalogue_report import new_scene

    given = {name: getattr(options, name) for name in SIZES}
    name = " ".join(options.designation)
    others = [*given.values(), options.contact_angle]
    if name == "shaft":
        scene = shipped_scenes()["shaft_gearbox"]
        print(scene.read_text("utf-8"), end="", flush=True)
        return SOLVED
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
    return SOLVED
