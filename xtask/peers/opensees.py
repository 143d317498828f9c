"""OpenSeesPy with friction as an elastic, perfectly plastic spring of a given yield displacement.

That material has one coefficient, the kinetic one.
"""

import ctypes
import os
import sysconfig
from pathlib import Path

import numpy as np


def load():
    """The module, silenced. Its wheel's own BLAS comes first: Python 3.11 does not find it alone."""
    bundled = Path(sysconfig.get_paths()["purelib"], "openseespylinux", "lib")
    for pattern in ("libquadmath*", "libgfortran*", "libblas*", "liblapack*"):
        for library in sorted(bundled.glob(pattern)):
            ctypes.CDLL(str(library), mode=ctypes.RTLD_GLOBAL)
    import openseespy.opensees as module

    module.logFile(os.devnull, "-noEcho")
    return module


def run(ops, case, yield_m, parts=1):
    """Sliding displacement at the record's samples; fails where a step does not converge."""
    dt, ground = case.finer(parts)
    ops.wipe()
    ops.model("basic", "-ndm", 1, "-ndf", 1)
    ops.node(1, 0.0)
    ops.node(2, 0.0)
    ops.fix(1, 1)
    ops.mass(2, case.block_kg)
    ops.uniaxialMaterial("ElasticPP", 1, case.kinetic_force / yield_m, yield_m)
    materials = [1]
    if case.spring:
        ops.uniaxialMaterial("Elastic", 2, case.spring)
        materials.append(2)
    ops.element("zeroLength", 1, 1, 2, "-mat", *materials, "-dir", *[1] * len(materials))
    if not case.rigid:
        ops.node(3, 0.0)
        ops.mass(3, case.floor_kg)
        ops.uniaxialMaterial("Elastic", 3, case.storey_spring, case.storey_damper)
        ops.element("zeroLength", 2, 2, 3, "-mat", 3, "-dir", 1)
    ops.timeSeries("Path", 1, "-dt", dt, "-values", *ground.tolist(), "-useLast")
    ops.pattern("UniformExcitation", 1, 1, "-accel", 1)
    ops.constraints("Plain")
    ops.numberer("Plain")
    ops.system("BandGeneral")
    ops.test("NormDispIncr", 1e-11, 50)
    ops.algorithm("Newton")
    ops.integrator("Newmark", 0.5, 0.25)
    ops.analysis("Transient")
    out = np.zeros(len(ground))
    for i in range(1, len(ground)):
        if ops.analyze(1, dt) != 0:
            # What its users do: another algorithm, then smaller steps.
            ops.algorithm("KrylovNewton")
            converged = ops.analyze(1, dt) == 0 or all(
                ops.analyze(1, dt / 20) == 0 for _ in range(20)
            )
            ops.algorithm("Newton")
            if not converged:
                raise ArithmeticError(f"no convergence at {i * dt:.3f} s")
        out[i] = ops.nodeDisp(2, 1)
    ops.wipe()
    return out[::parts]
