"""Prints what IfcOpenShell reads in IFC files, as JSON by their paths: problems, numbers of each class, what is stated of
buildings, roofs and faces, areas and corners in the world as they are drawn.
"""

import json
import sys

import ifcopenshell
import ifcopenshell.geom
import ifcopenshell.util.element
import ifcopenshell.util.geolocation
import ifcopenshell.util.shape
import ifcopenshell.validate

SETTINGS = ifcopenshell.geom.settings()
SETTINGS.set("use-world-coords", True)


def stated(element):
    parent = ifcopenshell.util.element.get_aggregate(element)
    sets = ifcopenshell.util.element.get_psets(element)
    return {"name": element.Name, "description": element.Description, "parent": parent and parent.Name, **sets}


def drawn(file, element):
    shape = ifcopenshell.geom.create_shape(SETTINGS, element).geometry
    corners = ifcopenshell.util.shape.get_vertices(shape)
    return {
        **stated(element),
        "area": ifcopenshell.util.shape.get_area(shape),
        "corners": [ifcopenshell.util.geolocation.auto_xyz2enh(file, *map(float, p)) for p in corners],
    }


def read(path, with_rules):
    file = ifcopenshell.open(path)
    logger = ifcopenshell.validate.json_logger()
    ifcopenshell.validate.validate(file, logger, express_rules=with_rules)
    site = file.by_type("IfcSite")[0]
    degrees = lambda angle: angle and ifcopenshell.util.geolocation.dms2dd(*angle)
    kinds = {
        "slabs": [slab for slab in file.by_type("IfcSlab") if slab.PredefinedType == "ROOF"],
        "grounds": [slab for slab in file.by_type("IfcSlab") if slab.PredefinedType == "BASESLAB"],
        "walls": file.by_type("IfcWall"),
        "ceilings": file.by_type("IfcCovering"),
    }
    return {
        "problems": [str(problem) for problem in logger.statements],
        "place": [degrees(site.RefLongitude), degrees(site.RefLatitude)],
        "buildings": [stated(building) for building in file.by_type("IfcBuilding")],
        "roofs": [stated(roof) for roof in file.by_type("IfcRoof")],
        **{kind: [drawn(file, face) for face in faces] for kind, faces in kinds.items()},
    }


# The schema's rules take five seconds a file: the last one alone is asked.
paths = sys.argv[1:]
print(json.dumps({path: read(path, path == paths[-1]) for path in paths}))
