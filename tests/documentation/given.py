"""What the pages take for granted: the files that a reader has before typing. All of it is synthetic."""

import os
import shutil
import subprocess
import sys
from pathlib import Path

import numpy as np
import pandas as pd
import tomli_w

from bench_hw.tables import TrialTable, write_trial_csv
from reports import write_csv
from tests.documentation.commands import ROOT
from tests.instruments.samples import cylinder_workbook, zwick_xlsx

CALL = (sys.executable, "-m", "benchmark")
CONTACT = "rigid_bonded"
"""What the sessions tell of the tool; the trials are those of `skin-5N`, whose pressure is uniform."""
CONTEXT = """schema = 1
name = "tool force in a trainer"
question_of_interest = "Is the force within 10 % of what a surgeon feels?"
context_of_use = "Presses to 5 N with tools of 2 to 8 mm radius."
model_influence = "high"
decision_consequence = "low"
quantities = ["maximum deformation"]
"""


def environment() -> dict[str, str]:
    """Of a command typed anywhere."""
    return {**os.environ, "PYTHONPATH": str(ROOT)}


def readers_files(folder: Path) -> None:
    """Two runs, a discovery, models, sessions, exports of instruments, records of attempts, rigs."""
    shutil.copy(ROOT / "examples" / "own_model.py", folder / "my_model.py")
    shutil.copytree(ROOT / "examples", folder / "examples")
    for words in (
        ("run", "skin-5N", "--out", "press"),
        ("run", "skin-5N", "--set", "dermis.youngs_modulus=120 kPa", "--out", "softer"),
        ("discover", "gel_pad", "--out", "found"),
        ("tissues", "new", "my_skin"),
        ("tissues", "new", "my_gel"),
    ):
        subprocess.run([*CALL, *words], cwd=folder, check=True, capture_output=True, env=environment())
    table = pd.read_csv(folder / "press" / "tables" / "max_deformation.csv")
    table.to_csv(folder / "my_fea.csv", index=False)
    (folder / "context.toml").write_text(CONTEXT)
    sessions(folder, table)
    exports(folder)
    attempts(folder)
    virtual_rig(folder, table)
    shutil.copy(folder / "rig.toml", folder / "my_rig.toml")


def sessions(folder: Path, table: pd.DataFrame) -> None:
    """A session of skin, a folder that has no `session.toml` yet, and two days of a silicone sheet."""
    presses(folder / "my_session", table)
    shutil.copytree(folder / "my_session", folder / "my_folder")
    (folder / "my_session" / "session.toml").write_text(_session("skin_forearm", "bonded"))
    for day in ("day_1", "day_2"):
        presses(folder / day, table)
        text = _session("rtv3498_sheet", "hole").replace('kind = "hole"', 'kind = "hole"\nhole_radius = "30 mm"')
        (folder / day / "session.toml").write_text(text)


def _session(specimen: str, support: str) -> str:
    speeds = ("slow", "fast")
    trials = "".join(
        f'\n[[trials]]\nfile = "trial_{trial:03d}.csv"\ncondition = "{speeds[trial % 2]}"\n' for trial in range(1, 9)
    )
    return (
        f'schema = 1\nname = "pressed"\nspecimen = "{specimen}"\nsynthetic = true\n\n[tool]\nradius = "5 mm"\n'
        f'contact = "{CONTACT}"\n\n[support]\nkind = "{support}"\n\n[drive]\nchannel = "depth"\n{trials}'
    )


def presses(folder: Path, table: pd.DataFrame) -> None:
    """Eight presses as the table has them, in two conditions' order of speed, with noise."""
    folder.mkdir()
    top = table[table["layer"] == table["layer"].iloc[0]]
    rng = np.random.default_rng(5)
    for trial in range(1, 9):
        slow = 0.5 if trial % 2 else 1.0
        depth = np.concatenate([[0.0, 0.0], top["fem_mm"].to_numpy()]) * 1e-3
        force = np.concatenate([[0.0, 0.0], top["force_N"].to_numpy()]) * rng.normal(1, 0.01)
        time = np.linspace(0.0, 10.0 / slow, len(depth))
        noisy = force + rng.normal(0, 5e-3, len(force))
        write_trial_csv(folder / f"trial_{trial:03d}.csv", TrialTable(time=time, depth=depth, force=noisy))


def exports(folder: Path) -> None:
    """A workbook of presses, one of compressed cylinders, and stress over strain in text."""
    zwick_xlsx(folder).rename(folder / "export.xlsx")
    cylinder_workbook(folder, "Druckversuch").rename(folder / "druckversuch.xlsx")
    strain = np.concatenate([np.zeros(20), np.linspace(0.0, 0.25, 200), np.linspace(0.25, 0.0, 200)])
    stress = 20.0 * ((1.0 - strain) ** -2 - (1.0 - strain)) + np.random.default_rng(6).normal(0.0, 0.02, strain.size)
    columns = {"time_s": 0.05 * np.arange(strain.size), "strain_%": 100.0 * strain, "stress_kPa": stress}
    write_csv(folder / "stress_strain.csv", columns)


def attempts(folder: Path) -> None:
    """Records as the press page saves them: one, and two groups of six, of which one trembles."""
    rng = np.random.default_rng(7)
    for group, tremor in (("expert", 0.05), ("novice", 0.5)):
        (folder / group).mkdir()
        for number in range(6):
            time = np.arange(0.0, 6.0, 0.01)
            x, y = 10.0 * np.cos(time), 10.0 * np.sin(time)
            depth = np.maximum(2.0 * np.sin(2.0 * time), 0.0) * rng.uniform(0.9, 1.1)
            shaken = x + tremor * np.sin(2.0 * np.pi * 9.0 * time + rng.uniform(0.0, 6.0))
            columns = {"time_s": time, "tool": np.zeros(time.size, dtype=int), "x_mm": shaken, "y_mm": y}
            write_csv(folder / group / f"{number}.csv", columns | {"depth_mm": depth, "force_N": 1.3 * depth})
    shutil.copy(folder / "expert" / "0.csv", folder / "press-record.csv")


def virtual_rig(folder: Path, table: pd.DataFrame) -> None:
    """`rig.toml` of simulated devices with a specimen that has no effect, so that a loop ends."""
    top = table[(table["layer"] == table["layer"].iloc[0]) & (table["step"] <= table["step"].max() // 2)]
    depth, force = [0.0, *top["fem_mm"].tolist()], [0.0, *top["force_N"].tolist()]
    specimen = {
        "schema": 1, "synthetic": True, "contact": CONTACT, "support": {"kind": "bonded"},
        "tools": [{"radius_mm": 5.0, "depth_mm": depth, "force_N": force}], "effects": {},
    }  # fmt: skip
    (folder / "specimen.toml").write_text(tomli_w.dumps(specimen))
    rig = {
        "schema": 1, "name": "virtual", "force": {"kind": "simulated", "rate": "100 Hz"},
        "actuator": {"kind": "simulated", "stroke": "50 mm", "accuracy": 1, "contact": "5 mm"},
        "simulation": {"specimen": "specimen.toml"},
    }  # fmt: skip
    (folder / "rig.toml").write_text(tomli_w.dumps(rig))
