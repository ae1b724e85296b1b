"""The bearing of an oracle case, built with the package."""

import warnings

import bearingjax as bj

NO_RIB = 1.0  # [m] gap of a rib that can never be reached
FLAT = 1e15  # [m] crown radius whose drop is below round-off


def profile(spec, uniform):
    match spec["type"]:
        case "straight":
            return bj.CircularCrown(FLAT) if uniform else bj.Straight()
        case "circular":
            return bj.CircularCrown(spec["radius"])
        case "crowned_ends":
            return bj.CrownedEnds(spec["straight_length"], spec["radius"])
        case "logarithmic":
            return bj.Logarithmic()
    raise ValueError(spec["type"])


def bearing(info, uniform=False):
    """Package bearing for an oracle description.

    Args:
        info: As `oracle.random_case` returns it.
        uniform: Stand-ins for absent ribs and straight profiles, so that many cases
            share one compilation.
    """
    names = ("outer_minus", "outer_plus", "inner_minus", "inner_plus")
    ribs = {n: bj.Rib(**spec) for n, spec in info["ribs"].items()}
    if uniform:
        stand_in = bj.Rib(10 * info["roller_diameter"], 0.0, NO_RIB)
        ribs = {n: ribs.get(n, stand_in) for n in names}
    material = bj.Material(info["young"], info["poisson"], 7850.0)
    common = dict(
        radial_internal_clearance=info["clearance"],
        first_azimuth=info["first_azimuth"],
        roller_profile=profile(info["profile"], uniform),
        outer_raceway_profile=profile(info["raceway_profile"]["outer"], uniform),
        inner_raceway_profile=profile(info["raceway_profile"]["inner"], uniform),
        ribs=bj.Ribs(**ribs),
        material=material,
    )
    size = [
        info[k]
        for k in ("n_rollers", "pitch_diameter", "roller_diameter", "roller_length")
    ]
    if info["kind"] == "cylindrical":
        return bj.CylindricalRollerBearing(*size, **common)
    with warnings.catch_warnings():
        # Random tapers have no common apex, and the package says so.
        warnings.simplefilter("ignore")
        return bj.TaperedRollerBearing(
            *size,
            **common,
            roller_axis_angle=info["roller_axis_angle"],
            roller_half_angle=info["roller_half_angle"],
        )
