"""Contexts, errors and callbacks: the one way from Python into the library.

A call of the library belongs to one context and one thread, so every Python thread has a session of
its own with a context and a registry of stages. The GIL is released during calls; log lines and
progress come back through it.
"""
import contextlib
import os
import threading
import warnings

from ._c import ffi, lib


class Error(Exception):
    """A call failed.

    `where` is the element the error is about (face, line, pivot, ... as the text says; -1 = none),
    `stage` the stage it happened in ("" = none), `status` its short name.
    """

    def __init__(self, text, status="failed", where=-1, stage=""):
        super().__init__(text)
        self.status, self.where, self.stage = status, where, stage


class Cancelled(Error):
    """The progress callback returned False."""


class NotPositiveDefinite(Error):
    """A pivot of the factorisation is not positive; `where` is its row."""


class QuadcoverWarning(UserWarning):
    """What the library repaired or left out, one line each."""


_classes = {
    lib.QC_ERR_CANCELLED: (Cancelled, ()),
    lib.QC_ERR_NOT_POSDEF: (NotPositiveDefinite, ()),
    lib.QC_ERR_ARGUMENT: (Error, (ValueError,)),
    lib.QC_ERR_NOT_FOUND: (Error, (LookupError,)),
    lib.QC_ERR_IO: (Error, (OSError,)),
    lib.QC_ERR_NOMEM: (Error, (MemoryError,)),
}


def text(pointer):
    """A C string, "" for NULL."""
    return "" if pointer == ffi.NULL else ffi.string(pointer).decode("utf-8", "replace")


def _class_of(status, made={}):
    """The exception of a status, which is also the built-in one that users would catch."""
    if status not in made:
        base, more = _classes.get(status, (Error, ()))
        made[status] = type(base.__name__, (base, *more), {"__module__": "quadcover"}) if more else base
    return made[status]


class _Callbacks:
    """What the library's callbacks see; apart from the session, so that no cycle keeps that."""

    progress, raised, lines = None, None, None


class Session:
    """A context with its registry; belongs to the thread that made it."""

    def __init__(self, threads=0):
        self.ctx = self.registry = None
        self.dependents, self.pid = 0, os.getpid()
        self.callbacks = _Callbacks()
        self.handle = ffi.new_handle(self.callbacks)
        options = ffi.new("qc_ctx_options *", {
            "struct_size": ffi.sizeof("qc_ctx_options"), "threads": threads,
            "log": lib.qc_python_log, "progress": lib.qc_python_progress, "user": self.handle})
        out = ffi.new("qc_ctx **")
        status = lib.qc_ctx_create(options, out)
        if status != lib.QC_OK:
            raise Error("cannot make a context", text(lib.qc_status_name(status)))
        self.ctx = out[0]
        out = ffi.new("qc_registry **")
        self.call(lib.qc_registry_create, out)
        self.registry = out[0]

    def __del__(self):
        # What was made through the context goes first; a garbage cycle may hold both, then they stay.
        if self.dependents > 0 or self.pid != os.getpid():
            return
        if self.registry is not None:
            lib.qc_registry_free(self.registry)
        if self.ctx is not None:
            lib.qc_ctx_free(self.ctx)

    def check(self, status):
        """Raises what a call reported; an exception of the progress callback goes first."""
        raised, self.callbacks.raised = self.callbacks.raised, None
        if raised is not None:
            raise raised
        if status == lib.QC_OK:
            return
        error = lib.qc_ctx_error(self.ctx)
        raise _class_of(status)(text(error.text) or text(lib.qc_status_name(status)),
                                text(lib.qc_status_name(status)), error.where, text(error.stage))

    def call(self, function, *arguments):
        """function(ctx, *arguments), checked."""
        self.check(function(self.ctx, *arguments))

    def make(self, kind, free, function, *arguments):
        """The new object which function(*arguments, out) makes; it keeps the session until freed."""
        out = ffi.new(kind + " **")
        self.check(function(*arguments, out))
        self.dependents += 1

        def release(pointer):
            free(pointer)
            self.dependents -= 1

        return ffi.gc(out[0], release)

    @contextlib.contextmanager
    def reporting(self, progress, lines=None):
        """Within: progress(fraction, stage) is called, and cancels by returning False; warnings are
        appended to the list `lines`, too."""
        before = self.callbacks.progress, self.callbacks.lines
        self.callbacks.progress, self.callbacks.lines = progress, lines
        try:
            yield self
        finally:
            self.callbacks.progress, self.callbacks.lines = before


_local = threading.local()
_threads = int(os.environ.get("QUADCOVER_THREADS", "0"))


def session():
    """The session of this thread."""
    if not hasattr(_local, "session") or _local.session.pid != os.getpid():
        _local.session = Session(_threads)
    return _local.session


def set_threads(threads):
    """Threads of calls made from now on by this Python thread; 0 = all cores. Results never change."""
    _local.session = Session(threads)


@ffi.def_extern()
def qc_python_log(user, level, stage, line):
    if level >= lib.QC_LOG_WARNING:
        prefix = text(stage)
        message = (prefix + ": " if prefix else "") + text(line)
        lines = ffi.from_handle(user).lines
        if lines is not None:
            lines.append(message)
        warnings.warn(message, QuadcoverWarning, stacklevel=2)


def _raised_outside(kind, error, traceback):
    """Ctrl-C may strike before the first line of the callback."""
    ffi.from_handle(traceback.tb_frame.f_locals["user"]).raised = error


@ffi.def_extern(error=False, onerror=_raised_outside)
def qc_python_progress(user, stage, fraction):
    # Python runs signal handlers between bytecodes of the main thread: here Ctrl-C arrives.
    callbacks = ffi.from_handle(user)
    try:
        return callbacks.progress is None or callbacks.progress(fraction, text(stage)) is not False
    except BaseException as error:
        callbacks.raised = error
        return False
