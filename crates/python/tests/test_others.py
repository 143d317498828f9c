"""Published examples of SciPy, SALib and scikit-learn, unchanged but for the objective, which is ours."""

import numpy as np
import pytest
from numpy.typing import NDArray

import slipstick as ss
from support import EXAMPLES

MODEL = ss.Model(
    block=ss.Block(mass="325 kg"),
    slider=ss.Slider(static_friction=0.06, kinetic_friction=0.05, radius="2 m"),
    storey=[ss.Storey(mass="201 kg", frequency="2.15 Hz", damping_ratio=0.01)],
)
PATHS = ["slider.radius", "storey.1.mass", "storey.1.frequency"]
BOUNDS = [[1.0, 4.0], [150.0, 250.0], [8.0, 20.0]]


def motion() -> ss.Motion:
    taft = ss.read_record(EXAMPLES / "records" / "taft-111.txt", units="g", dt=0.01)
    return taft["3 s":"8 s"].scaled(pga="0.4 g")  # type: ignore[misc]


def evaluate(x: NDArray[np.float64]) -> NDArray[np.float64]:
    """The peak acceleration of the storey in g: of rows of designs, as SALib and scikit-learn ask."""
    table = ss.demands(MODEL, motion(), dict(zip(PATHS, x.T)), check=0.0)
    return np.asarray(table["storey1_peak_acceleration_m_per_s2"]) / 9.80665


def rosen(x: NDArray[np.float64]) -> NDArray[np.float64] | float:
    """The same of one design or of columns of them, as SciPy asks."""
    found = evaluate(np.atleast_2d(x.T))
    return found if x.ndim > 1 else float(found[0])


def test_examples_of_scipy() -> None:
    optimize = pytest.importorskip("scipy.optimize")
    differential_evolution, Bounds = optimize.differential_evolution, optimize.Bounds
    # From the documentation of differential_evolution.
    bounds = [tuple(bound) for bound in BOUNDS]
    common = {"maxiter": 3, "popsize": 4, "seed": 1, "polish": False}
    result = differential_evolution(rosen, bounds, updating="deferred", **common)
    parallel = differential_evolution(rosen, bounds, updating="deferred", workers=2, **common)
    vectorized = differential_evolution(rosen, bounds, vectorized=True, updating="deferred", **common)
    assert result.fun == parallel.fun == vectorized.fun < rosen(np.mean(BOUNDS, axis=1))
    # From that of minimize.
    res = optimize.minimize(rosen, vectorized.x, method="Nelder-Mead", bounds=Bounds(*zip(*bounds)), options={"maxiter": 20})
    assert res.fun <= vectorized.fun
    # A step of any solver is a scalar of NumPy.
    root = optimize.brentq(
        lambda mu: ss.run(MODEL.with_({"slider.kinetic_friction": mu}), motion(), history=False, check=False)
        .summary["peak_sliding_displacement_m"] - 0.1,
        0.005, 0.06, xtol=1e-6, full_output=True, disp=False,
    )
    assert 0.005 <= root[0] <= 0.06


def test_examples_of_salib() -> None:
    pytest.importorskip("SALib")
    # From its documentation, "Basics".
    from SALib import ProblemSpec
    from SALib.analyze import sobol
    from SALib.sample import sobol as saltelli

    problem = {"num_vars": 3, "names": PATHS, "bounds": BOUNDS}
    param_values = saltelli.sample(problem, 32)
    Y = np.zeros([param_values.shape[0]])
    for i, X in enumerate(param_values[:8]):
        Y[i] = rosen(X)
    assert Y[:8].tolist() == evaluate(param_values)[:8].tolist()
    Si = sobol.analyze(problem, evaluate(param_values))
    assert Si["ST"].shape == (3,) and np.isfinite(Si["ST"]).all()
    # And with its method chaining.
    sp = ProblemSpec({"names": PATHS, "bounds": BOUNDS, "outputs": ["Y"]})
    sp.sample_sobol(32).evaluate(evaluate).analyze_sobol()
    assert np.isfinite(sp.analysis["S1"]).all()


def test_examples_of_scikit_learn() -> None:
    pytest.importorskip("sklearn")
    from sklearn.pipeline import make_pipeline
    from sklearn.preprocessing import FunctionTransformer, StandardScaler

    low, high = np.array(BOUNDS).T
    X = low + (high - low) * np.random.default_rng(1).random((16, 3))
    transformer = FunctionTransformer(evaluate, validate=True)
    assert transformer.transform(X).tolist() == evaluate(X).tolist()
    column = FunctionTransformer(lambda designs: evaluate(designs)[:, np.newaxis])
    assert abs(make_pipeline(column, StandardScaler()).fit_transform(X).mean()) < 1e-12
