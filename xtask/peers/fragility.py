"""Reference values of the fragility fits, by statsmodels and SciPy: data/reference/fragility.json.

    python3 -m venv target/sm && target/sm/bin/pip install numpy scipy statsmodels
    target/sm/bin/python xtask/peers/fragility.py > data/reference/fragility.json

Estimates in statsmodels stop at a tolerance of their own, so each is followed by Newton's iteration on
the scores in the natural parameters (mean and standard deviation), with derivatives by complex steps.
"""

import json
import sys

import numpy as np
import scipy
import statsmodels
import statsmodels.api as sm
from scipy import optimize, special, stats
from statsmodels.stats.diagnostic import lilliefors, normal_ad
from statsmodels.stats.proportion import proportion_confint

CONFIDENCE = 0.9
Z = stats.norm.ppf(0.5 + CONFIDENCE / 2)


def distributions():
    x = [-40.0, -12.0, -7.0, -6.0, -5.9, -2.5, -1.0, -1e-3, 0.0, 0.3, 1.0, 3.0, 6.5, 9.0]
    p = [1e-300, 1e-50, 1e-12, 1e-4, 0.01, 0.021, 0.05, 0.16, 0.3, 0.5, 0.6, 0.84, 0.975, 0.999999]
    chi = [[0.1, 1], [3.0, 1], [2.5, 5], [11.07, 5], [40.0, 12], [6.0, 12], [300.0, 18]]
    beta = [[0.05, 3, 42], [0.95, 4, 41], [0.5, 10, 1], [0.025, 1, 20], [0.975, 39, 6]]
    return {
        "normal_cdf": [[v, special.ndtr(v)] for v in x if v > -30],
        "ln_normal_cdf": [[v, special.log_ndtr(v)] for v in x],
        "normal_quantile": [[v, special.ndtri(v)] for v in p],
        "chi_squared_tail": [[v, k, stats.chi2.sf(v, k)] for v, k in chi],
        "beta_quantile": [[q, a, b, stats.beta.ppf(q, a, b)] for q, a, b in beta],
    }


def proportions():
    rows = []
    for k, n in [(0, 10), (3, 10), (37, 44), (40, 44), (44, 44), (500, 1000)]:
        wilson = proportion_confint(k, n, 1 - CONFIDENCE, "wilson")
        exact = proportion_confint(k, n, 1 - CONFIDENCE, "beta")
        rows.append({"count": k, "runs": n, "wilson": list(wilson), "clopper_pearson": list(exact)})
    return rows


def polished(log_likelihood, start):
    """Maximum by SciPy, then Newton's iteration on the score, whose derivatives are complex steps."""
    start = optimize.minimize(lambda p: -log_likelihood(p), start, method="Nelder-Mead",
                              options={"xatol": 1e-10, "fatol": 1e-13, "maxiter": 20000}).x
    k = len(start)

    def score(p):
        # Richardson's extrapolation of central differences: logcdf takes no complex numbers.
        out = np.empty(k)
        for i in range(k):
            def central(h):
                e = np.zeros(k)
                e[i] = h
                return (log_likelihood(p + e) - log_likelihood(p - e)) / (2 * h)
            h = 2e-3 * max(1.0, abs(p[i]))
            d = [central(h / 2**j) for j in range(4)]
            for m in range(1, 4):
                d = [(4**m * d[j + 1] - d[j]) / (4**m - 1) for j in range(len(d) - 1)]
            out[i] = d[0]
        return out

    def information(p):
        out = np.empty((k, k))
        for i in range(k):
            e = np.zeros(k)
            e[i] = h = 1e-4 * max(1.0, abs(p[i]))
            out[i] = (score(p - 2 * e) - 8 * score(p - e) + 8 * score(p + e) - score(p + 2 * e)) / (12 * h) * -1
        return (out + out.T) / 2

    p = start
    for _ in range(6):
        p = p + np.linalg.solve(information(p), score(p))
    return p, np.linalg.inv(information(p)), log_likelihood(p)


def profile_interval(log_likelihood, estimate, covariance, top, index):
    """Ends of the interval of one natural parameter by profile likelihood."""
    others = [i for i in range(len(estimate)) if i != index]

    def lost(v):
        def rest(u):
            p = np.array(estimate, float)
            p[index] = v
            p[others] = u
            return -log_likelihood(p)
        start = np.array(estimate)[others]
        best = optimize.minimize(rest, start, method="Nelder-Mead",
                                 options={"xatol": 1e-11, "fatol": 1e-14, "maxiter": 40000})
        return 2 * (top + best.fun) - Z**2

    se = np.sqrt(covariance[index, index])
    ends = []
    for side in (-1, 1):
        far = estimate[index]
        for _ in range(30):
            far += side * se
            if index == len(estimate) - 1 and far <= 0:
                far = 1e-3 * estimate[index]
            if lost(far) > 0:
                break
        ends.append(optimize.brentq(lost, estimate[index], far, xtol=1e-12, rtol=1e-12))
    return ends


STRIPES = {
    "baker-like": [[0.1, 40, 0], [0.2, 40, 0], [0.3, 40, 4], [0.4, 40, 6], [0.5, 40, 13],
                   [0.6, 40, 12], [0.7, 40, 20], [0.8, 40, 28], [0.9, 40, 31], [1.0, 40, 34]],
    "few": [[0.2, 11, 1], [0.4, 11, 4], [0.8, 11, 10]],
    "unequal": [[0.05, 7, 0], [0.15, 22, 3], [0.22, 5, 1], [0.31, 44, 19], [0.9, 3, 3]],
}


def stripes():
    cases = []
    for name, rows in STRIPES.items():
        x = np.array([r[0] for r in rows])
        n = np.array([r[1] for r in rows])
        k = np.array([r[2] for r in rows])
        design = sm.add_constant(np.repeat(np.log(x), n))
        y = np.concatenate([[1] * b + [0] * (a - b) for a, b in zip(n, k)])
        probit = sm.Probit(y, design).fit(disp=0, tol=1e-15, maxiter=200, method="newton")
        grouped = sm.GLM(np.column_stack([k, n - k]), sm.add_constant(np.log(x)),
                         family=sm.families.Binomial(sm.families.links.Probit())).fit(tol=1e-14)
        a, b = probit.params
        # The optimiser keeps the second derivatives of its last step but one.
        v = np.linalg.inv(-probit.model.hessian(probit.params))
        # d(ln theta) and d(beta) by a and b.
        to_theta = np.array([-1 / b, a / b**2])
        to_beta = np.array([0.0, -1 / b**2])
        at = np.array([0.5 * x[0], np.median(x), 1.3 * x[-1]])
        form = np.column_stack([np.ones(3), np.log(at)])
        eta, se = form @ probit.params, np.sqrt(np.einsum("ij,jk,ik->i", form, v, form))

        def log_likelihood(p):
            if p[1] <= 0:
                return -np.inf
            z = (np.log(x) - p[0]) / p[1]
            return float(np.sum(k * special.log_ndtr(z) + (n - k) * special.log_ndtr(-z)))

        natural = np.array([-a / b, 1 / b])
        cov = np.array([[to_theta @ v @ to_theta, to_theta @ v @ to_beta],
                        [to_theta @ v @ to_beta, to_beta @ v @ to_beta]])
        cases.append({
            "name": name, "stripes": rows, "median": float(np.exp(-a / b)), "dispersion": 1 / b,
            "log_likelihood": probit.llf, "se_ln_median": float(np.sqrt(cov[0, 0])),
            "se_dispersion": float(np.sqrt(cov[1, 1])), "deviance": grouped.deviance,
            "pearson": grouped.pearson_chi2, "degrees": int(grouped.df_resid),
            "p_value": stats.chi2.sf(grouped.deviance, grouped.df_resid),
            "band": [[s, special.ndtr(e - Z * d), special.ndtr(e + Z * d)] for s, e, d in zip(at, eta, se)],
            "median_interval": list(np.exp(profile_interval(log_likelihood, natural, cov, probit.llf, 0))),
            "dispersion_interval": profile_interval(log_likelihood, natural, cov, probit.llf, 1),
        })
    return cases


def capacities():
    rng = np.random.default_rng(20040901)
    cases = []
    for name, n, cap in [("all-reached", 22, np.inf), ("censored", 44, 0.55), ("few", 5, 0.9)]:
        level = np.round(np.exp(np.log(0.45) + 0.42 * rng.standard_normal(n)), 4)
        reached = level < cap
        level = np.where(reached, level, cap)
        y = np.log(level)

        def log_likelihood(p):
            if p[1] <= 0:
                return -np.inf
            z = (y - p[0]) / p[1]
            return float(np.sum(np.where(reached, stats.norm.logpdf(z) - np.log(p[1]), special.log_ndtr(-z))))

        p, v, top = polished(log_likelihood, [y.mean(), y.std() + 0.1])
        case = {
            "name": name, "levels": level.tolist(), "reached": reached.tolist(),
            "median": float(np.exp(p[0])), "dispersion": float(p[1]), "log_likelihood": top,
            "se_ln_median": float(np.sqrt(v[0, 0])), "se_dispersion": float(np.sqrt(v[1, 1])),
            "median_interval": list(np.exp(profile_interval(log_likelihood, p, v, top, 0))),
            "dispersion_interval": profile_interval(log_likelihood, p, v, top, 1),
        }
        if reached.all():
            shape, _, scale = stats.lognorm.fit(level, floc=0)
            assert abs(shape - p[1]) < 1e-6 and abs(scale - np.exp(p[0])) < 1e-6
            ad, ad_p = normal_ad(y)
            case["moments"] = [float(np.exp(y.mean())), float(y.std(ddof=1))]
            case["anderson_darling"], case["anderson_darling_p"] = float(ad), float(ad_p)
            case["largest_difference"] = float(lilliefors(y, pvalmethod="approx")[0])
        cases.append(case)
    return cases


def clouds():
    rng = np.random.default_rng(20030605)
    cases = []
    for name, n, floor, cap in [("free", 30, 0.0, np.inf), ("censored", 60, 0.01, 0.3)]:
        x = np.round(np.exp(np.log(0.4) + 0.6 * rng.standard_normal(n)), 4)
        d = np.exp(np.log(0.12) + 1.7 * np.log(x / 0.4) + 0.5 * rng.standard_normal(n))
        d = np.round(d, 5)
        known = np.where(d < floor, "at most", np.where(d > cap, "at least", "exactly"))
        d = np.clip(d, floor, cap)
        limit = 0.15
        lx, ly = np.log(x), np.log(d)

        def log_likelihood(p):
            if p[2] <= 0:
                return -np.inf
            z = (ly - p[0] - p[1] * lx) / p[2]
            return float(np.sum(np.where(known == "exactly", stats.norm.logpdf(z) - np.log(p[2]),
                                         np.where(known == "at most", special.log_ndtr(z), special.log_ndtr(-z)))))

        ols = sm.OLS(ly, sm.add_constant(lx)).fit()
        p, v, top = polished(log_likelihood, [*ols.params, np.sqrt(ols.scale)])
        if name == "free":
            assert np.allclose(p, [*ols.params, np.sqrt(ols.ssr / n)], rtol=1e-9)
            assert abs(top - ols.llf) < 1e-9
        at = np.array([0.1, 0.5, 1.2])
        # eta = (a + b ln x - ln L) / sigma and its derivatives.
        eta = (p[0] + p[1] * np.log(at) - np.log(limit)) / p[2]
        form = np.column_stack([np.full(3, 1 / p[2]), np.log(at) / p[2], -eta / p[2]])
        se = np.sqrt(np.einsum("ij,jk,ik->i", form, v, form))
        cases.append({
            "name": name, "levels": x.tolist(), "demands": d.tolist(), "known": known.tolist(), "limit": limit,
            "intercept": p[0], "slope": p[1], "sigma": p[2], "log_likelihood": top,
            "median": float(np.exp((np.log(limit) - p[0]) / p[1])), "dispersion": p[2] / p[1],
            "band": [[s, special.ndtr(e - Z * q), special.ndtr(e + Z * q)] for s, e, q in zip(at, eta, se)],
        })
    return cases


def delta(curve, parameters, covariance):
    """Standard errors of what follows from the parameters, by derivatives in complex steps."""
    k = len(parameters)
    steps = [curve([q + (1e-30j if i == j else 0) for j, q in enumerate(parameters)]) for i in range(k)]
    to = np.array([[value.imag / 1e-30 for value in row] for row in steps]).T
    return np.sqrt(np.diag(to @ covariance @ to.T))


def with_t(case, median, dispersion, errors, groups):
    """Intervals as statsmodels gives them with use_t: Student's t on the number of groups less one."""
    t = stats.t.ppf(0.5 + CONFIDENCE / 2, groups - 1)
    case |= {"median": median, "dispersion": dispersion, "se_ln_median": errors[0], "se_dispersion": errors[1],
             "median_interval": [median * np.exp(s * t * errors[0]) for s in (-1, 1)],
             "dispersion_interval": [dispersion * np.exp(s * t * errors[1] / dispersion) for s in (-1, 1)]}
    return case


def clustered_stripes():
    """Records times designs times levels, a term of each record in common: Probit clustered by record."""
    cases = []
    for name, records, designs, levels, seed in [("suite", 20, 50, 10, 11), ("small", 6, 4, 5, 12)]:
        rng = np.random.default_rng(seed)
        x = np.round(np.linspace(0.1, 1.0, levels), 4)
        of_record = 0.35 * rng.standard_normal(records)
        rows, group, ln_x, beyond = [], [], [], []
        for r in range(records):
            for level in x:
                own = of_record[r] + 0.25 * rng.standard_normal(designs)
                exceeds = (np.log(level / 0.45) + own > 0).astype(int)
                rows.append([r, level, designs, int(exceeds.sum())])
                group += [r] * designs
                ln_x += [np.log(level)] * designs
                beyond += exceeds.tolist()
        model = sm.Probit(np.array(beyond), sm.add_constant(np.array(ln_x)))
        start = model.fit(disp=0, tol=1e-15, maxiter=200, method="newton").params
        fit = model.fit(start_params=start, disp=0, tol=1e-15, maxiter=200, method="newton",
                        cov_type="cluster", cov_kwds={"groups": np.array(group)}, use_t=True)
        a, b = fit.params
        errors = delta(lambda p: [-p[0] / p[1], 1 / p[1]], fit.params, fit.cov_params())
        # What the same fit says where runs are taken as independent.
        naive = delta(lambda p: [-p[0] / p[1], 1 / p[1]], fit.params, np.linalg.inv(-model.hessian(fit.params)))
        # The bounds of the linear predictor at three levels, by statsmodels' own t.
        at = np.array([0.5 * x[0], x[levels // 2], 1.3 * x[-1]])
        form = np.column_stack([np.ones(3), np.log(at)])
        ends = special.ndtr(fit.t_test(form).conf_int(1 - CONFIDENCE))
        case = {"name": name, "rows": rows, "naive_se_ln_median": naive[0], "log_likelihood": fit.llf,
                "band": [[s, *pair] for s, pair in zip(at, ends)]}
        cases.append(with_t(case, float(np.exp(-a / b)), 1 / b, errors, records))
    return cases


def clustered_pairs():
    """Single runs of two components a pair, a term of each pair in common: Probit clustered by pair."""
    rng = np.random.default_rng(15)
    pairs, x = 12, np.round(np.linspace(0.15, 0.9, 6), 4)
    rows = []
    for pair in range(pairs):
        of_pair = 0.35 * rng.standard_normal()
        for component in range(2):
            for level in x:
                own = of_pair + 0.2 * rng.standard_normal()
                rows.append([pair, component, level, int(np.log(level / 0.4) + own > 0)])
    ln_x = sm.add_constant(np.log([row[2] for row in rows]))
    beyond = np.array([row[3] for row in rows])
    case = {"rows": rows}
    for by, group in [("pair", [row[0] for row in rows]), ("component", [2 * row[0] + row[1] for row in rows])]:
        model = sm.Probit(beyond, ln_x)
        start = model.fit(disp=0, tol=1e-15, maxiter=200, method="newton").params
        fit = model.fit(start_params=start, disp=0, tol=1e-15, maxiter=200, method="newton",
                        cov_type="cluster", cov_kwds={"groups": np.array(group)}, use_t=True)
        a, b = fit.params
        errors = delta(lambda p: [-p[0] / p[1], 1 / p[1]], fit.params, fit.cov_params())
        case[by] = with_t({}, float(np.exp(-a / b)), 1 / b, errors, len(set(group)))
    return case


def sandwich(scores, hessian, group, k):
    """Cluster-robust covariance with the correction of statsmodels' cov_cluster."""
    groups = np.unique(group)
    summed = np.array([scores[group == g].sum(axis=0) for g in groups])
    n, count = len(group), len(groups)
    bread = np.linalg.inv(-hessian)
    return count / (count - 1) * (n - 1) / (n - k) * bread @ (summed.T @ summed) @ bread


def clustered_likelihood(of_each, start, group):
    """Maximum and cluster-robust covariance of a likelihood given observation by observation."""
    total = lambda p: float(np.sum(of_each(p)))
    p, covariance, _ = polished(total, start)
    k = len(p)
    scores = np.empty((len(group), k))
    for i in range(k):
        def central(h):
            e = np.zeros(k)
            e[i] = h
            return (of_each(p + e) - of_each(p - e)) / (2 * h)
        h = 2e-3 * max(1.0, abs(p[i]))
        d = [central(h / 2**j) for j in range(4)]
        for m in range(1, 4):
            d = [(4**m * d[j + 1] - d[j]) / (4**m - 1) for j in range(len(d) - 1)]
        scores[:, i] = d[0]
    return p, sandwich(scores, -np.linalg.inv(covariance), group, k)


def clustered_capacities():
    """Twelve records with four designs each, some known from below only."""
    rng = np.random.default_rng(13)
    group = np.repeat(np.arange(12), 4)
    level = np.round(np.exp(np.log(0.5) + 0.3 * rng.standard_normal(12)[group] + 0.15 * rng.standard_normal(48)), 4)
    reached = level < 0.8
    level = np.where(reached, level, 0.8)
    y = np.log(level)

    def of_each(p):
        z = (y - p[0]) / p[1]
        return np.where(reached, stats.norm.logpdf(z) - np.log(p[1]), special.log_ndtr(-z))

    p, v = clustered_likelihood(of_each, [y.mean(), y.std()], group)
    case = {"levels": level.tolist(), "reached": reached.tolist(), "records": group.tolist()}
    return with_t(case, float(np.exp(p[0])), float(p[1]), np.sqrt(np.diag(v)), 12)


def clustered_cloud():
    """Ten records with six runs each."""
    rng = np.random.default_rng(14)
    group = np.repeat(np.arange(10), 6)
    x = np.round(np.exp(np.log(0.4) + 0.6 * rng.standard_normal(60)), 4)
    d = np.round(np.exp(np.log(0.12) + 1.7 * np.log(x / 0.4) + 0.4 * rng.standard_normal(10)[group]
                        + 0.2 * rng.standard_normal(60)), 5)
    lx, ly, ln_limit = np.log(x), np.log(d), np.log(0.15)

    def of_each(p):
        return stats.norm.logpdf((ly - p[0] - p[1] * lx) / p[2]) - np.log(p[2])

    ols = sm.OLS(ly, sm.add_constant(lx)).fit()
    p, v = clustered_likelihood(of_each, [*ols.params, np.sqrt(ols.scale)], group)
    # The line's own covariance is that of statsmodels but for the count of parameters.
    robust = sm.OLS(ly, sm.add_constant(lx)).fit(cov_type="cluster", cov_kwds={"groups": group})
    assert np.allclose(v[:2, :2] * (60 - 3) / (60 - 2), robust.cov_params(), rtol=1e-6)
    errors = delta(lambda p: [(ln_limit - p[0]) / p[1], p[2] / p[1]], p, v)
    case = {"levels": x.tolist(), "demands": d.tolist(), "records": group.tolist(), "limit": 0.15}
    return with_t(case, float(np.exp((ln_limit - p[0]) / p[1])), float(p[2] / p[1]), errors, 10)


json.dump({
    "origin": f"xtask/peers/fragility.py with numpy {np.__version__}, scipy {scipy.__version__}, "
              f"statsmodels {statsmodels.__version__}",
    "confidence": CONFIDENCE,
    "distributions": distributions(),
    "proportions": proportions(),
    "stripes": stripes(),
    "capacities": capacities(),
    "clouds": clouds(),
    "clustered": {"stripes": clustered_stripes(), "capacities": clustered_capacities(), "cloud": clustered_cloud(),
                  "pairs": clustered_pairs()},
}, sys.stdout, indent=1, default=float)
print()
