"""Modes of a building of three floors in the layout in which SAP2000 and ETABS export tables.

Not from those programs: the numbers are computed here, the layout follows what others publish of exports. Writes
sap2000-layout.csv (kN, m) and etabs-layout.csv (N, mm; decimals after a comma).
"""

from pathlib import Path

import numpy as np

masses_t = np.array([420.0, 400.0, 380.0])
radius_m, off_m = 6.5, 0.9  # radius of gyration; centre of stiffness behind that of mass, along y
chain = lambda k: np.array([[k[0] + k[1], -k[1], 0], [-k[1], k[1] + k[2], -k[2]], [0, -k[2], k[2]]])
kx, ky, kt = chain([1.0e6, 9e5, 7e5]), chain([8e5, 7e5, 6e5]), chain([6e7, 5e7, 4e7])
zero = np.zeros((3, 3))
# u_x of the centre of mass, u_y, rotation; the springs along x act at -off_m, those along y at +off_m/2.
k = np.block([[kx, zero, off_m * kx], [zero, ky, 0.5 * off_m * ky],
              [off_m * kx, 0.5 * off_m * ky, kt + off_m**2 * kx + (0.5 * off_m) ** 2 * ky]])
m = np.concatenate([masses_t, masses_t, masses_t * radius_m**2])
root = np.sqrt(m)
values, vectors = np.linalg.eigh(k / np.outer(root, root))
phi = vectors / root[:, None]  # m, of modal mass 1 kN m s²
periods = 2 * np.pi / np.sqrt(values)
factors = [phi[3 * a:3 * a + 3].T @ masses_t for a in range(2)]  # kN s²
ratios = [f**2 / masses_t.sum() for f in factors]
n = len(periods)


def sap2000():
    lines = ['TABLE:  "Modal Periods And Frequencies"',
             "OutputCase,StepType,StepNum,Period,Frequency,CircFreq,Eigenvalue",
             "Text,Text,Unitless,Sec,Cyc/sec,rad/sec,rad2/sec2"]
    lines += [f"MODAL,Mode,{j + 1},{periods[j]:.6f},{1 / periods[j]:.6f},{values[j]**.5:.6f},{values[j]:.4f}"
              for j in range(n)]
    lines += ["", 'TABLE:  "Modal Participating Mass Ratios"',
              "OutputCase,StepType,StepNum,Period,UX,UY,UZ,SumUX,SumUY,SumUZ,RX,RY,RZ,SumRX,SumRY,SumRZ",
              "Text,Text,Unitless,Sec" + 12 * ",Unitless"]
    sums = [np.cumsum(r) for r in ratios]
    lines += [f"MODAL,Mode,{j + 1},{periods[j]:.6f},{ratios[0][j]:.6f},{ratios[1][j]:.6f},0,{sums[0][j]:.6f},"
              f"{sums[1][j]:.6f},0,0,0,0,0,0,0" for j in range(n)]
    lines += ["", 'TABLE:  "Modal Participation Factors"',
              "OutputCase,StepType,StepNum,Period,UX,UY,UZ,RX,RY,RZ,ModalMass,ModalStiff",
              "Text,Text,Unitless,Sec,KN-s2,KN-s2,KN-s2,KN-m-s2,KN-m-s2,KN-m-s2,KN-m-s2,KN-m"]
    lines += [f"MODAL,Mode,{j + 1},{periods[j]:.6f},{factors[0][j]:.6f},{factors[1][j]:.6f},0,0,0,0,1,{values[j]:.5f}"
              for j in range(n)]
    lines += ["", 'TABLE:  "Joint Displacements"',
              "Joint,OutputCase,CaseType,StepType,StepNum,U1,U2,U3,R1,R2,R3",
              "Text,Text,Text,Text,Unitless,m,m,m,Radians,Radians,Radians"]
    for i, joint in enumerate(["C1", "C2", "C3"]):
        lines.append(f"{joint},DEAD,LinStatic,,,0,0,-0.001,0,0,0")
        lines += [f"{joint},MODAL,LinModal,Mode,{j + 1},{phi[i, j]:.9f},{phi[3 + i, j]:.9f},0,0,0,{phi[6 + i, j]:.9f}"
                  for j in range(n)]
    return "\n".join(lines) + "\n"


def etabs():
    comma = lambda x, d: f"{x:.{d}f}".replace(".", ",")
    lines = ["TABLE:  Modal Participating Mass Ratios",
             "Case;Mode;Period;UX;UY;UZ;SumUX;SumUY;SumUZ;RX;RY;RZ;SumRX;SumRY;SumRZ", ";;sec" + 12 * ";"]
    sums = [np.cumsum(r) for r in ratios]
    lines += [f"Modal;{j + 1};{comma(periods[j], 3)};{comma(ratios[0][j], 4)};{comma(ratios[1][j], 4)};0;"
              f"{comma(sums[0][j], 4)};{comma(sums[1][j], 4)};0;0;0;0;0;0;0" for j in range(n)]
    lines += ["", "TABLE:  Modal Participation Factors",
              "Case;Mode;Period;UX;UY;UZ;RX;RY;RZ;Modal Mass;Modal Stiffness",
              ";;sec;N-s2;N-s2;N-s2;N-mm-s2;N-mm-s2;N-mm-s2;N-mm-s2;N-mm"]
    # Modal mass 1 N mm s² = 1e-6 kN m s²: shapes in mm.
    lines += [f"Modal;{j + 1};{comma(periods[j], 3)};{comma(factors[0][j], 6)};{comma(factors[1][j], 6)};0;0;0;0;1;"
              f"{comma(values[j], 4)}" for j in range(n)]
    lines += ["", "TABLE:  Joint Displacements",
              "Story;Label;Unique Name;Output Case;Case Type;Step Type;Step Number;Ux;Uy;Uz;Rx;Ry;Rz",
              ";;;;;;;mm;mm;mm;rad;rad;rad"]
    for i, story in enumerate(["Story1", "Story2", "Roof"]):
        lines += [f"{story};7;{107 + i};Modal;LinModal;Mode;{j + 1};{comma(phi[i, j], 9)};{comma(phi[3 + i, j], 9)};0;0;0;0"
                  for j in range(n)]
    return "\n".join(lines) + "\n"


order = np.argsort(-periods)
periods, values, phi = periods[order], values[order], phi[:, order]
factors, ratios = [f[order] for f in factors], [r[order] for r in ratios]
Path("sap2000-layout.csv").write_text(sap2000())
Path("etabs-layout.csv").write_text(etabs())
