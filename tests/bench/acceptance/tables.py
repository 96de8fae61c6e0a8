"""Tables of outcomes, as text or as Markdown."""
from runs import GOOD, VALID


class Table:
    """Rows under a head; columns are wide enough, the last one is text."""

    def __init__(self, head, markdown):
        self.rows, self.markdown = [head], markdown

    def add(self, *cells):
        self.rows.append(cells)

    def show(self):
        rows = [[str(c) for c in row] for row in self.rows]
        if self.markdown:
            rows.insert(1, ["---"] + ["---:"] * (len(rows[0]) - 2) + ["---"])
            for row in rows:
                print("| " + " | ".join(row) + " |" if row[0] != "---" else "|" + "|".join(row) + "|")
            return
        width = [max(len(row[k]) for row in rows) for k in range(len(rows[0]) - 1)]
        for row in rows:
            print(" ".join(c.rjust(w) if k else c.ljust(w) for k, (c, w) in enumerate(zip(row, width))), row[-1])


def name(a, run):
    return f"`{run.mode}`" if a.markdown else run.mode


def seconds(some):
    found = sorted(o["seconds"] for _, o in some)
    return [f"{found[len(found) // 2]:.1f}", f"{found[-1]:.1f}"]


def by_mode(a, outcomes):
    """Modes x densities, and who was not good."""
    table = Table(["mode", "quads", "good", "of", "median s", "longest s", "not good"], a.markdown)
    for mode, quads in dict.fromkeys((run.mode, run.quads) for run, _ in outcomes):
        some = [(run, o) for run, o in outcomes if (run.mode, run.quads) == (mode, quads)]
        bad = [f"{run.model.name} ({o['status']})" for run, o in some if o["status"] != GOOD]
        table.add(name(a, some[0][0]), quads, len(some) - len(bad), len(some), *seconds(some), ", ".join(bad))
    table.show()


def by_class(a, outcomes):
    """Classes of models, for each mode and density, and who has no valid result."""
    table = Table(["class", "mode", "quads", "models", "valid", "within 5 %", "with warnings", "median s", "longest s",
                   "without a valid result"], a.markdown)
    for kind, mode, quads in dict.fromkeys((run.model.kind, run.mode, run.quads) for run, _ in outcomes):
        some = [(run, o) for run, o in outcomes if (run.model.kind, run.mode, run.quads) == (kind, mode, quads)]
        bad = [f"{run.model.name} ({o['status']})" for run, o in some if o["status"] not in VALID]
        warned = sum(1 for _, o in some if o["status"] in VALID and o["warnings"])
        table.add(kind, name(a, some[0][0]), quads, len(some), len(some) - len(bad),
                  sum(o["status"] == GOOD for _, o in some), warned, *seconds(some), ", ".join(bad))
    table.show()
