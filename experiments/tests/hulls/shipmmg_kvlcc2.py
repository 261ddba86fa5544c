"""Writes shipmmg_kvlcc2.csv beside this file: tracks of KVLCC2 by the program shipmmg, an MMG simulator from PyPI that is no part of this project.

It was run once, and is no part of any test:

    python3 -m venv venv && venv/bin/pip install shipmmg==0.0.11 scipy numpy && venv/bin/python shipmmg_kvlcc2.py

shipmmg differs from the standard method of Yasukawa & Yoshimura (2015) in two laws: its wake is w_P0 exp(-4 (beta - x_P r')^2), and its
drift angle is that of the point x_G before the one whose sway velocity it integrates. Without wake (w_P0 = 0) and with the centre of
gravity at midship (x_G = 0) both programs claim to solve the same equations; these cases are the rows `common ...`. The other
parameters are those of KVLCC2 at full scale.
"""

import datetime
import importlib.metadata
import pathlib
import platform

import numpy as np
from shipmmg.mmg_3dof import Mmg3DofBasicParams, Mmg3DofManeuveringParams, simulate_mmg_3dof

RHO, LENGTH, DRAUGHT, VOLUME = 1025.0, 320.0, 20.8, 312600.0
MASS, DIAMETER, SPAN = RHO * VOLUME, 9.86, 15.8
SPEED, RATE = 7.97, 1.4

BASIC = Mmg3DofBasicParams(
    L_pp=LENGTH, B=58.0, d=DRAUGHT, x_G=0.0, D_p=DIAMETER, m=MASS, I_zG=MASS * (0.25 * LENGTH) ** 2,
    A_R=112.5, η=DIAMETER / SPAN,
    m_x=0.022 * 0.5 * RHO * LENGTH**2 * DRAUGHT,
    m_y=0.223 * 0.5 * RHO * LENGTH**2 * DRAUGHT,
    J_z=0.011 * 0.5 * RHO * LENGTH**4 * DRAUGHT,
    f_α=2.747, ϵ=1.09, t_R=0.387, x_R=-0.5 * LENGTH, a_H=0.312, x_H=-0.464 * LENGTH,
    γ_R_minus=0.395, γ_R_plus=0.640, l_R=-0.710, κ=0.50, t_P=0.220, w_P0=0.0, x_P=-0.48,
)
MANEUVERING = Mmg3DofManeuveringParams(
    k_0=0.2931, k_1=-0.2753, k_2=-0.1385, R_0_dash=0.022,
    X_vv_dash=-0.040, X_vr_dash=0.002, X_rr_dash=0.011, X_vvvv_dash=0.771,
    Y_v_dash=-0.315, Y_r_dash=0.083, Y_vvv_dash=-1.607, Y_vvr_dash=0.379, Y_vrr_dash=-0.391, Y_rrr_dash=0.008,
    N_v_dash=-0.137, N_r_dash=-0.049, N_vvv_dash=-0.030, N_vvr_dash=-0.294, N_vrr_dash=0.055, N_rrr_dash=-0.013,
)

# The rudder [rad] as a smooth function of time [s], so that both programs have the same.
CASES = {
    "common turn starboard": lambda t: np.radians(35.0) * (1.0 - np.exp(-((t / 10.0) ** 2))),
    "common turn port": lambda t: -np.radians(35.0) * (1.0 - np.exp(-((t / 10.0) ** 2))),
    "common swing": lambda t: np.radians(20.0) * np.sin(2.0 * np.pi * t / 300.0),
}


def main():
    """Simulates every case for 900 s and writes its state every 20 s."""
    time = np.linspace(0.0, 900.0, 9001)
    versions = ", ".join(f"{name} {importlib.metadata.version(name)}" for name in ["shipmmg", "scipy", "numpy"])
    lines = [
        f"# shipmmg_kvlcc2.py, {datetime.date.today()}, {versions}, Python {platform.python_version()}; u0 {SPEED} m/s, n {RATE} rps",
        "case,t,x,y,psi,u,v,r,delta",
    ]
    for name, rudder in CASES.items():
        solution = simulate_mmg_3dof(
            BASIC, MANEUVERING, time, rudder(time), np.full(len(time), RATE), u0=SPEED, ρ=RHO,
            method="DOP853", rtol=1e-10, atol=1e-12,
        )
        for t in range(0, 901, 20):
            u, v, r, x, y, psi, delta, _ = solution.sol(float(t))
            lines.append(f"{name},{t},{x:.6f},{y:.6f},{psi:.9f},{u:.9f},{v:.9f},{r:.12f},{delta:.9f}")
    pathlib.Path(__file__).with_name("shipmmg_kvlcc2.csv").write_text("\n".join(lines) + "\n")


main()
