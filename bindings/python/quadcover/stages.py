"""Every registered stage as a function, made from its table: ports and parameters are keywords.

    field = quadcover.stages.field_smoothest(mesh=mesh).field
    map = quadcover.stages.hodge(matching=matching, sizing=sizing)

Names which are words of Python end in an underscore (lambda_). The result is the object on the one output port, or a named tuple of several. Each function also
takes `progress`, called as progress(fraction, stage); False cancels.
"""
import collections
import inspect
import keyword

from ._c import ffi, lib
from ._context import session, text
from ._objects import Object, wrap

__all__ = []


def _name(stage_id):
    """qc.field.smooth -> field_smooth"""
    return (stage_id[3:] if stage_id.startswith("qc.") else stage_id).replace(".", "_").replace("-", "_")


def _spell(name):
    """A parameter's name as a keyword."""
    return name + "_" if keyword.iskeyword(name) else name


def _default(parameter):
    value = getattr(parameter, "def")  # a keyword in Python, not in C
    if parameter.type == lib.QC_BOOL:
        return bool(value)
    if parameter.type == lib.QC_INT:
        return int(value)
    if parameter.type == lib.QC_ENUM:
        return text(parameter.choices[int(value)])
    return value if parameter.type == lib.QC_REAL else None


def _as_text(value):
    if isinstance(value, bool):
        return "true" if value else "false"
    return repr(float(value)) if isinstance(value, float) else str(value)


def _document(stage, inputs, outputs, parameters):
    lines = [text(stage.brief), "", text(stage.doc), ""]
    if stage.cite != ffi.NULL:
        lines += ["Source: " + text(stage.cite), ""]
    lines.append("Inputs:")
    for p in inputs:
        optional = ", optional" if p.flags & lib.QC_PORT_OPTIONAL else ""
        lines.append("    %s (%s%s): %s" % (text(p.name), text(p.type), optional, text(p.doc)))
    lines.append("Parameters:")
    for p in parameters:
        unit = " [%s]" % text(p.unit) if text(p.unit) else ""
        lines.append("    %s = %r%s: %s" % (_spell(text(p.name)), _default(p), unit, text(p.doc)))
    lines.append("Returns:")
    lines += ["    %s (%s): %s" % (text(p.name), text(p.type), text(p.doc)) for p in outputs]
    return "\n".join(lines)


def _run(stage_id, inputs, parameters, outputs, result, given, progress):
    s = session()
    bag = s.make("qc_bag", lib.qc_bag_free, lib.qc_bag_create, s.ctx)
    pipeline = s.make("qc_pipeline", lib.qc_pipeline_free, lib.qc_pipeline_create, s.registry)
    s.check(lib.qc_pipeline_insert(pipeline, 0, b"step", stage_id.encode()))
    for name in inputs:
        value = given.get(name)
        if value is None:
            s.check(lib.qc_pipeline_wire(pipeline, b"step", name.encode(), b""))
            continue
        if not isinstance(value, Object):
            raise TypeError("%s is a %s; give an object of quadcover" % (name, type(value).__name__))
        s.check(lib.qc_bag_put(bag, name.encode(), value._c))
        s.check(lib.qc_pipeline_wire(pipeline, b"step", name.encode(), name.encode()))
    for name in parameters:
        value = given.get(_spell(name))
        if value is not None:
            s.check(lib.qc_pipeline_set(pipeline, b"step", name.encode(), _as_text(value).encode()))
    with s.reporting(progress):
        s.check(lib.qc_pipeline_run(pipeline, bag))
    values = [wrap(lib.qc_object_retain(lib.qc_bag_get(bag, ("step." + name).encode())))
              for name in outputs]
    return values[0] if len(values) == 1 else result(*values)


def _make(stage):
    inputs = [lib.qc_stage_in(stage, i)[0] for i in range(stage.n_in)]
    outputs = [lib.qc_stage_out(stage, i)[0] for i in range(stage.n_out)]
    parameters = [lib.qc_stage_param(stage, i)[0] for i in range(stage.n_params)]
    stage_id, name = text(stage.id), _name(text(stage.id))
    in_names, out_names = [text(p.name) for p in inputs], [text(p.name) for p in outputs]
    parameter_names = [text(p.name) for p in parameters]
    only = inspect.Parameter.KEYWORD_ONLY
    listed = [inspect.Parameter(
        text(p.name), only,
        default=None if p.flags & lib.QC_PORT_OPTIONAL else inspect.Parameter.empty) for p in inputs]
    listed += [inspect.Parameter(_spell(text(p.name)), only, default=_default(p)) for p in parameters]
    listed.append(inspect.Parameter("progress", only, default=None))
    signature = inspect.Signature(listed)
    result = collections.namedtuple(name + "_result", out_names) if len(out_names) > 1 else None

    def call(**given):
        bound = signature.bind(**given).arguments
        return _run(stage_id, in_names, parameter_names, out_names, result, bound,
                    bound.pop("progress", None))

    call.__name__ = call.__qualname__ = name
    call.__doc__ = _document(stage, inputs, outputs, parameters)
    call.__signature__ = signature
    call.id, call.version = stage_id, text(stage.version)
    return call


def _add(stage):
    call = _make(stage)
    globals()[call.__name__] = call
    if call.__name__ not in __all__:
        __all__.append(call.__name__)
    return call


def load_plugin(path):
    """Loads a plugin library for this thread's calls; its stages become functions here."""
    s = session()
    before = lib.qc_registry_count(s.registry)
    s.check(lib.qc_registry_load(s.registry, str(path).encode()))
    return [_add(lib.qc_registry_stage(s.registry, i))
            for i in range(before, lib.qc_registry_count(s.registry))]


for _i in range(lib.qc_registry_count(session().registry)):
    _add(lib.qc_registry_stage(session().registry, _i))
