"""mssim, a benchmark harness for parallel mass-spring simulation: the program itself is mssim.program."""
import os
import sys
from pathlib import Path

program = Path(__file__).parent / "bin" / "mssim"


def main():
    os.execv(program, [str(program), *sys.argv[1:]])
