"""Reads vehicle.dbc with canmatrix and compares its decoding of our frames with our own.

usage: canmatrix_test.py VEHICLE_DBC PRINT_FRAMES
"""

import logging
import math
import subprocess
import sys

logging.disable(logging.WARNING)  # the import warns about every format whose package is missing
try:
    import canmatrix.formats
except ImportError:
    sys.exit("canmatrix_test.py: python3-canmatrix is not installed")
logging.disable(logging.NOTSET)


class Warnings(logging.Handler):
    def __init__(self):
        super().__init__(logging.WARNING)
        self.texts = []

    def emit(self, record):
        self.texts.append(record.getMessage())


def load(path):
    warnings = Warnings()
    logging.getLogger().addHandler(warnings)
    matrices = canmatrix.formats.loadp(path)
    assert not warnings.texts, f"canmatrix warns: {warnings.texts}"
    (matrix,) = matrices.values()
    assert not matrix.load_errors, f"canmatrix reports: {matrix.load_errors}"
    return {frame.arbitration_id.id: frame for frame in matrix.frames}


def compare(line, frames):
    """Returns the id and multiplexor value of the frame, and how many values were compared."""
    number, payload, *fields = line.split()
    frame = frames[int(number)]
    ours = {name: float(value) for name, value in (field.split("=") for field in fields)}
    page = None
    if frame.is_multiplexed:
        page = int(ours[frame.get_multiplexer.name])
        known = {signal.mux_val for signal in frame.signals if signal.mux_val is not None}
        if page not in known:  # random bits that select no page: only the signals outside the pages are present
            known_signals = {s.name for s in frame.signals if s.mux_val is None}
            assert set(ours) == known_signals, line
            return frame.name, page, 0
    theirs = {name: float(value.phys_value) for name, value in frame.decode(bytes.fromhex(payload)).items()}
    assert set(ours) == set(theirs), f"{line}\n  canmatrix sees {sorted(theirs)}"
    for name, value in ours.items():
        assert math.isclose(value, theirs[name], rel_tol=1e-12, abs_tol=1e-12), f"{line}\n  {name} is {theirs[name]}"
    return frame.name, page, len(ours)


def main():
    frames = load(sys.argv[1])
    assert len(frames) == 15, f"{len(frames)} messages"
    output = subprocess.run([sys.argv[2]], check=True, stdout=subprocess.PIPE, text=True).stdout
    kinds = set()
    values = 0
    for line in output.splitlines():
        name, page, count = compare(line, frames)
        kinds.add((name, page))
        values += count
    assert {name for name, _ in kinds} == {frame.name for frame in frames.values()}
    assert {page for name, page in kinds if name == "ObstacleObject"} >= {0, 1, 2}
    assert values > 5000, f"only {values} values compared"
    print(f"{values} values of {len(output.splitlines())} frames agree")


main()
