"""Writes src/orienting/orientation/units/epsg.txt, the units of EPSG's coordinate systems.

    pip install pyproj && python3 tests/evaluation/epsg_units.py

pyproj and PROJ are under the MIT licence; the numbers are of the EPSG Geodetic Parameter Dataset of
the International Association of Oil & Gas Producers, which may be distributed as it is (epsg.org,
terms of use).
"""

from pathlib import Path

import pyproj
from pyproj.database import get_database_metadata, query_crs_info
from pyproj.enums import PJType

OUT = Path(__file__).parents[2] / "src/orienting/orientation/units/epsg.txt"
KINDS = {
    PJType.PROJECTED_CRS: "plan",
    PJType.GEOGRAPHIC_2D_CRS: "degrees",
    PJType.GEOGRAPHIC_3D_CRS: "degrees",
    PJType.GEOCENTRIC_CRS: "geocentric",
    PJType.COMPOUND_CRS: "compound",
    PJType.VERTICAL_CRS: "height",
}


def units():
    """Of each code in plan and of each in height: metres of the unit, or the name of an angle."""
    plan, height = {}, {}
    for kind, name in KINDS.items():
        for info in query_crs_info("EPSG", [kind], allow_deprecated=True):
            code = int(info.code)
            axes = pyproj.CRS.from_epsg(code).axis_info
            if name == "height":
                height[code] = repr(axes[0].unit_conversion_factor)
                continue
            unit = axes[0].unit_name
            angle = next((a for a in ("degree", "grad") if unit.startswith(a)), None)
            metres = repr(axes[0].unit_conversion_factor)
            plan[code] = name if name == "geocentric" else angle or metres
            if len(axes) == 3 and name != "geocentric":
                height[code] = repr(axes[2].unit_conversion_factor)
    return plan, height


def runs(codes, unit, used):
    """First and last code of each run with this unit, over numbers that no system has."""
    found = []
    for code in sorted(c for c, u in codes.items() if u == unit):
        between = range(found[-1][1] + 1, code) if found else ()
        if found and not used.intersection(between):
            found[-1][1] = code
        else:
            found.append([code, code])
    return [str(a) if a == b else f"{a}-{b}" for a, b in found]


def main():
    plan, height = units()
    lines = [
        f"# Units of coordinate systems by their codes: EPSG {get_database_metadata('EPSG.VERSION')},"
        f" by PROJ {pyproj.proj_version_str};",
        "# written by tests/evaluation/epsg_units.py, which says the licences. Metres of a unit, or",
        "# its name; plan: codes that are not listed are in metres; height: they state no height.",
    ]
    used = {*plan, *height}
    for name, codes in (("plan", plan), ("height", height)):
        for unit in sorted(set(codes.values())):
            if (name, unit) != ("plan", "1.0"):
                lines.append(" ".join([name, unit, *runs(codes, unit, used)]))
    OUT.write_text("\n".join(lines) + "\n")


if __name__ == "__main__":
    main()
