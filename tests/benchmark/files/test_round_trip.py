"""What is written reads back as an equal model, whatever it holds."""

import math
import tomllib

from hypothesis import given, settings
from hypothesis import strategies as st

from benchmark.files import Layer, Scenario, Source, Support, Tissue, Tool, scenario_from_table, tissue_from_table
from benchmark.files.load import Load
from benchmark.files.physics import Physics
from benchmark.files.scenario import Comparison, FemOptions, WaveOptions
from benchmark.files.tissue import Fibre, Gent, MooneyRivlin, NeoHookean, Ogden, OgdenTerm, PronyTerm, Yeoh

letters = st.characters(exclude_categories=("C", "Z"), include_characters=" ")
names = st.text(letters, min_size=1, max_size=30).filter(str.strip)
moduli = st.floats(0.01, 1e12)
lengths = st.floats(1e-6, 1e4)
small = st.floats(1e-6, 10.0)
maybe = lambda strategy: st.none() | strategy  # noqa: E731

laws = st.one_of(
    st.builds(NeoHookean, c10=maybe(moduli)),
    st.builds(Yeoh, law=st.just("yeoh"), c10=moduli, c20=st.floats(-1e6, 1e6), c30=st.floats(-1e6, 1e6)),
    st.builds(MooneyRivlin, law=st.just("mooney_rivlin"), c10=moduli, c01=st.floats(0, 1e6)),
    st.builds(Gent, law=st.just("gent"), mu=moduli, jm=small),
    st.builds(Ogden, law=st.just("ogden"), terms=st.tuples(st.builds(OgdenTerm, mu=moduli, alpha=st.floats(0.1, 20)))),
)
prony = st.lists(
    st.builds(PronyTerm, g=st.floats(1e-6, 0.2), tau=st.floats(1e-6, 1e6)), max_size=4, unique_by=lambda term: term.tau
)
fibres = st.builds(Fibre, angle=st.floats(-3.14, 3.14), k1=moduli, k2=small, dispersion=st.floats(0, 1 / 3))
layers = st.builds(
    Layer,
    name=names,
    thickness=lengths,
    density=st.floats(0.01, 1e5),
    youngs_modulus=moduli,
    poisson_ratio=st.floats(0, 0.49999),
    hyperelastic=laws,
    relaxation=prony.map(tuple),
    fibre=maybe(fibres),
)
tissues = st.builds(
    Tissue,
    name=names,
    citation=st.text(max_size=80),
    max_force=maybe(st.floats(1e-6, 1e9)),
    layers=st.lists(layers, min_size=1, max_size=4, unique_by=lambda layer: layer.name).map(tuple),
)
tools = st.builds(
    Tool,
    radius=st.floats(1e-3, 10),
    contact=st.sampled_from(["uniform_pressure", "rigid_bonded"]),
    edge_radius=maybe(st.floats(1e-6, 1e-3)),
    position=st.tuples(st.floats(-1, 1), st.floats(-1, 1)),
    tilt=st.floats(-1, 1),
)
peaks = st.floats(1e-6, 1e3) | st.floats(-1e3, -1e-6)
rows = st.lists(st.tuples(st.floats(1e-3, 1e6), peaks), min_size=1, max_size=6, unique_by=lambda row: row[0])
loads = st.one_of(
    st.builds(
        Load,
        control=st.sampled_from(["force", "depth"]),
        peak=peaks,
        shape=st.sampled_from(["triangle", "ramp", "ramp_hold"]),
        duration=st.floats(1e-6, 1e7),
        observations=st.integers(2, 1_000_000),
        hold=st.floats(1e-6, 1e7),
    ),
    st.builds(
        Load,
        control=st.sampled_from(["force", "depth"]),
        shape=st.just("table"),
        table=rows.map(lambda each: tuple(sorted(each))),
        observations=maybe(st.integers(1, 100)),
    ),
)
physics = st.builds(
    Physics,
    pretension=maybe(moduli),
    interface_shear_limit=maybe(moduli),
    clamp_shear_limit=maybe(moduli),
    friction_coefficient=maybe(st.floats(0, 10)),
    adhesion_force=maybe(st.floats(0, 1e3)),
    floor_depth=lengths,
    floor_stiffness=maybe(st.floats(1e-3, 1e8)),
    damping_time=maybe(st.floats(1e-6, 1e7)),
    drainage_share=st.floats(0, 0.99),
    drainage_diffusivity=st.floats(1e-15, 1),
)
scenarios = st.builds(
    Scenario,
    name=names,
    tissue=tissues,
    tool=tools,
    support=st.builds(Support, kind=st.sampled_from(["bonded", "half_space"]), hole_radius=maybe(lengths)),
    load=loads,
    physics=physics,
    comparison=st.builds(Comparison, equivalence_margin=st.floats(1e-6, 1)),
    fem=st.builds(
        FemOptions,
        kinematics=st.sampled_from(["finite", "linear"]),
        mesh=st.sampled_from(["coarse", "default", "fine"]),
        radius=maybe(st.floats(11, 1e6)),
    ),
    wave=st.builds(WaveOptions, modes=maybe(st.integers(1, 4096)), window=maybe(st.floats(21, 1e6))),
)


@settings(max_examples=60)
@given(tissue=tissues)
def test_a_tissue(tissue):
    assert tissue_from_table(tomllib.loads(tissue.to_toml()), Source("written")) == tissue


@settings(max_examples=100)
@given(scenario=scenarios)
def test_a_scenario(scenario):
    again = scenario_from_table(tomllib.loads(scenario.to_toml()), Source("written"))
    assert again == scenario
    assert again.to_toml() == scenario.to_toml()


def test_an_endless_layer():
    fat = Layer(name="fat", thickness=math.inf, density=971.0, youngs_modulus=20e3, poisson_ratio=0.48)
    tissue = Tissue(name="half", layers=(fat,))
    assert "thickness" not in tissue.to_toml()
    assert tissue_from_table(tomllib.loads(tissue.to_toml()), Source("written")) == tissue


def test_a_resolved_file_states_every_default_with_units():
    fat = Layer(name="fat", thickness=0.01, density=971.0, youngs_modulus=20e3, poisson_ratio=0.48)
    scenario = Scenario(name="n", tissue=Tissue(name="t", layers=(fat,)), tool=Tool(radius=5e-3), load=Load(peak=5.0))
    table = scenario.to_table()
    assert table["schema"] == table["tissue"]["schema"] == 1
    assert table["tool"] == {
        "radius": "5 mm",
        "contact": "uniform_pressure",
        "position": ["0 mm", "0 mm"],
        "tilt": "0 deg",
    }
    assert table["load"] == {
        "control": "force",
        "peak": "5 N",
        "shape": "triangle",
        "duration": "10 s",
        "observations": 100,
    }
    assert table["comparison"] == {"equivalence_margin": "2 %"}
    assert table["fem"] == {"kinematics": "finite", "geometry": "axisymmetric", "mesh": "default", "radius": "auto"}
    assert table["wave"] == {"model": "layered", "modes": "auto", "window": "auto", "large_press": "auto"}
