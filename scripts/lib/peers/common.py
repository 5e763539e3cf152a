"""What the peers share beside mssim's protocol: how a system's springs look to a program that gathers, and what a note says."""

import io
import tokenize

import mssim_backend
import numpy as np

# The springs of a node of a cloth: rows and columns to the other end, and the kind (0 structural, 1 shear, 2 bending).
FORWARD = [(0, 1, 0), (1, 0, 0), (1, 1, 1), (1, -1, 1), (0, 2, 2), (2, 0, 2)]
ALL_TWELVE = FORWARD + [(-row, -column, kind) for row, column, kind in FORWARD]


def kinds(system):
    """stiffness, stiffness times rest length and damping of a cloth's three kinds of springs, over the mass: [3], double."""
    mass = system.mass[0]
    first = [np.flatnonzero(system.kind == kind)[0] for kind in range(3)]
    if np.any(system.mass != mass) or np.any(system.rest_length != system.rest_length[first][system.kind]):
        raise mssim_backend.Unsupported("the nodes of a cloth, and its springs of a kind, must be alike")
    k = system.stiffness[first] / mass
    return k, k * system.rest_length[first], system.damping[first] / mass


def free_nodes(system, dtype=np.float32):
    """[nodes] 1 where a node moves, 0 where it is pinned."""
    free = np.ones(system.nodes, dtype)
    free[system.pins] = 0
    return free


def neighbours(system):
    """Each node's springs side by side (CSR): starts [nodes + 1], other ends and numbers of the springs [2 springs]."""
    springs = system.springs.astype(np.int64)
    this = springs.ravel()
    other = springs[:, ::-1].ravel()
    order = np.lexsort((other, this))
    starts = np.zeros(system.nodes + 1, np.int32)
    np.cumsum(np.bincount(this, minlength=system.nodes), out=starts[1:])
    return starts, other[order].astype(np.int32), order // 2


def lines_of_code(path):
    """Lines of a Python file without blank lines, comments and descriptions (strings that stand alone)."""
    lines, fresh = set(), True
    with open(path, encoding="utf-8") as file:
        tokens = list(tokenize.generate_tokens(io.StringIO(file.read()).readline))
    for token in tokens:
        if token.type in (tokenize.COMMENT, tokenize.NL, tokenize.INDENT, tokenize.DEDENT, tokenize.ENDMARKER):
            continue
        if token.type == tokenize.NEWLINE:
            fresh = True
            continue
        if not (fresh and token.type == tokenize.STRING):
            lines.update(range(token.start[0], token.end[0] + 1))
        fresh = False
    return len(lines)


def note(path, version, settings):
    """For the `note` of a row."""
    return f"{version}; {settings}; {lines_of_code(path)} lines"
