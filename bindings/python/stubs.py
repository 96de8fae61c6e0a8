"""Type stubs of quadcover.stages from `quadcover stages --json` on stdin."""
import json
import keyword
import sys

kinds = {"bool": "bool", "int": "int", "real": "float", "enum": "str", "text": "str"}
classes = {
    "qc.polygon_mesh/1": "PolygonMesh", "qc.mesh/1": "Mesh", "qc.features/1": "Features",
    "qc.repair_report/1": "RepairReport", "qc.sizing/1": "Sizing", "qc.face_field/1": "FaceField",
    "qc.matching/1": "Matching", "qc.seamless_map/1": "SeamlessMap",
    "qc.corner_map/1": "CornerMap", "qc.report/1": "Report",
}


def spell(name):
    return name + "_" if keyword.iskeyword(name) else name


def stub(stage):
    """The result tuple, where there is one, and the function of a stage."""
    name = stage["id"].removeprefix("qc.").replace(".", "_").replace("-", "_")
    lines, outputs = [], stage["out"]
    result = classes.get(outputs[0]["type"], "Object") if outputs else "None"
    if len(outputs) > 1:
        result = name + "_result"
        lines.append("class %s(NamedTuple):" % result)
        for port in outputs:
            kind = classes.get(port["type"], "Object")
            lines.append("    %s: %s" % (port["name"], "Optional[%s]" % kind if port["optional"] else kind))
        lines.append("")
    lines.append("def %s(" % name)
    lines.append("    *,")
    for port in stage["in"]:
        kind = classes.get(port["type"], "Object")
        lines.append("    %s: %s," % (port["name"],
                                      "Optional[%s] = None" % kind if port["optional"] else kind))
    for p in stage["params"]:
        lines.append("    %s: %s = ...," % (spell(p["name"]), kinds[p["type"]]))
    lines.append("    progress: Optional[Callable[[float, str], Optional[bool]]] = None,")
    lines.append(") -> %s: ..." % result)
    return "\n".join(lines)


stages = json.load(sys.stdin)["stages"]
print("from typing import Callable, List, NamedTuple, Optional\n")
print("from ._objects import (%s)\n" % ", ".join(sorted(set(classes.values()) | {"Object"})))
print("__all__: List[str]\n")
print("def load_plugin(path: str) -> list: ...\n")
print("\n\n".join(stub(s) for s in stages))
