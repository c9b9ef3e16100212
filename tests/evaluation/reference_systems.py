"""Writes planes.rs and grids.rs of src/orienting/orientation/epsg from EPSG's registry: which codes
name the same plane, and which of them are transverse Mercator projections. Run it with pyproj (3.7) installed:

    python3 tests/evaluation/reference_systems.py
"""

import re
from pathlib import Path

from pyproj import CRS, Proj, Transformer
from pyproj.database import query_crs_info
from pyproj.enums import PJType

OUT = Path(__file__).parents[2] / "src/orienting/orientation/epsg"

# Realisations of one datum: they lie a metre or two apart, and all of a scene alike.
GLOBAL = re.compile(
    r"WGS 84|World Geodetic System 1984|ITRF|ETR[FS]|European Terrestrial|NAD83|North American Datum "
    r"1983|GDA|Geocentric Datum of Australia|JGD20|Japanese Geodetic Datum 20|SIRGAS|NZGD2000|New "
    r"Zealand Geodetic Datum 2000|CSRS|RGF93|Reseau Geodesique Francais 1993|International "
    r"Terrestrial|KGD2002|Korean"
)


def is_global(crs):
    """Is the datum one of those that count as WGS84?"""
    if crs.ellipsoid is None or crs.ellipsoid.name not in ("GRS 1980", "WGS 84"):
        return False
    if GLOBAL.search(crs.datum.name):
        return True
    area = crs.area_of_use
    lon, lat = (area.west + area.east) / 2, (area.south + area.north) / 2
    way = Transformer.from_crs(crs.geodetic_crs.to_2d(), CRS(4326), always_xy=True)
    x, y = way.transform(lon, lat)
    # A way whose accuracy is not known changes nothing, for want of any better.
    return way.accuracy >= 0 and abs(x - lon) + abs(y - lat) < 3 / 111e3


def plane(crs):
    """The projection, its parameters in metres and degrees, and the datum."""
    operation = crs.coordinate_operation
    values = {}
    for p in operation.params:
        factor = p.unit_conversion_factor
        is_angle = p.unit_name not in ("metre", "unity") and "foot" not in p.unit_name
        is_angle = is_angle and p.unit_category.startswith("angular")
        value = p.value * factor * (57.29577951308232 if is_angle else 1)
        values[p.name] = round(value, 9 if is_angle or p.unit_name == "unity" else 2)
    datum = "global" if is_global(crs) else crs.datum.name
    return operation.method_name, tuple(sorted(values.items())), datum


def codes(*kinds):
    infos = [i for kind in kinds for i in query_crs_info(auth_name="EPSG", pj_types=kind, allow_deprecated=True)]
    return sorted({int(i.code) for i in infos if int(i.code) <= 32767})


def transverse(key):
    """Central meridian, scale, false easting and the northing of the equator."""
    method, values, datum = key
    if method != "Transverse Mercator" or datum != "global":
        return None
    v = dict(values)
    lat, lon = v["Latitude of natural origin"], v["Longitude of natural origin"]
    k, east = v["Scale factor at natural origin"], v["False easting"]
    north = v["False northing"]
    if not 0.5 < k < 2:
        return None
    grid = Proj(proj="tmerc", lat_0=lat, lon_0=lon, k_0=k, x_0=east, y_0=north, ellps="GRS80")
    return lon, k, east, round(grid(lon, 0.0)[1], 4)


same, planes, metre = {}, {}, {}
old = {int(i.code) for i in query_crs_info(auth_name="EPSG", allow_deprecated=True) if i.deprecated}
for code in codes(PJType.GEOGRAPHIC_2D_CRS, PJType.GEOGRAPHIC_3D_CRS):
    crs = CRS.from_epsg(code)
    if crs.prime_meridian.longitude == 0 and crs.axis_info[0].unit_name.startswith("degree") and is_global(crs):
        same[code] = 4326
for code in codes(PJType.PROJECTED_CRS):
    crs = CRS.from_epsg(code)
    if crs.coordinate_operation is None or crs.prime_meridian.longitude != 0:
        continue
    planes.setdefault(plane(crs), []).append(code)
    metre[code] = crs.axis_info[0].unit_name == "metre"
grids = {}
for key, members in planes.items():
    is_utm = lambda code: 32601 <= code <= 32660 or 32701 <= code <= 32760
    is_nad = lambda code: 26900 <= code <= 32199
    best = min(members, key=lambda c: (not is_utm(c), not metre[c], not is_nad(c), c in old, c))
    same.update({code: best for code in members})
    if found := transverse(key):
        grids[best] = found
for code in codes(PJType.COMPOUND_CRS):
    of_plane = CRS.from_epsg(code).sub_crs_list[0].to_epsg(100)
    if of_plane:
        same[code] = same.get(of_plane, of_plane)


def same_rows():
    rows = []
    for code, to in sorted(same.items()):
        if code == to:
            continue
        if rows:
            first, count, of_first, step = rows[-1]
            steps = [step] if count > 1 else [0, 1]
            fits = [s for s in steps if code == first + count and to == of_first + s * count]
            if fits:
                rows[-1] = (first, count + 1, of_first, fits[0])
                continue
        rows.append((code, 1, to, 0))
    return rows


def grid_rows():
    rows = []
    for code, (lon, k, east, north) in sorted(grids.items()):
        if rows:
            first, count, of_first, steps = rows[-1]
            far = [lon - of_first[0], east - of_first[2]]
            steps = steps if count > 1 else far
            is_next = code == first + count and of_first[1::2] == (k, north)
            is_whole = all(s == int(s) for s in steps)
            if is_next and is_whole and far == [s * count for s in steps]:
                rows[-1] = (first, count + 1, of_first, steps)
                continue
        rows.append((code, 1, (lon, k, east, north), [0.0, 0.0]))
    return rows


def write(name, of_row, row, of_table, table, lines, count):
    """A module with the type of a row and the table, a documentation comment each."""
    text = f"""//! Written by tests/evaluation/reference_systems.py from EPSG's registry: do not edit.

{of_row}
pub(super) struct {row};

{of_table}
#[rustfmt::skip]
pub(super) static {table}: [{row.split("(")[0]}; {count}] = [
{lines}
];
"""
    (OUT / name).write_text(text)


rows = same_rows()
cells = [f"Same({a}, {n}, {b}, {s})," for a, n, b, s in rows]
write(
    "planes.rs",
    "/// So many codes from the first on stand for the same plane as the codes from the third on,\n"
    "/// by steps of the fourth (0 or 1).",
    "Same(pub u16, pub u16, pub u16, pub u16)",
    "/// Codes of the same plane, sorted.",
    "SAME",
    "\n".join("    " + " ".join(cells[i : i + 4]) for i in range(0, len(cells), 4)),
    len(rows),
)
rows = grid_rows()
write(
    "grids.rs",
    "/// So many codes from the first on: central meridian, scale, easting of it and northing of the\n"
    "/// equator (degrees, metres) of the first, and by how much meridian and easting grow from code\n"
    "/// to code.",
    "Grids(pub u16, pub u16, pub [f64; 4], pub [i32; 2])",
    "/// Transverse Mercator projections of the datums that count as WGS84, sorted.",
    "GRIDS",
    "\n".join(f"    Grids({a}, {n}, {[float(v) for v in first]}, {[int(s) for s in steps]})," for a, n, first, steps in rows),
    len(rows),
)
