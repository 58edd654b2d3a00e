import numpy as np

from benchmark.files import load_session
from benchmark.sessions import SHIPPED
from benchmark.sessions.make_phantom import COUNT, NOISE, PRESS, one_press, remembered_noise


def test_the_shipped_session_is_whole_and_says_that_it_is_synthetic() -> None:
    session = load_session(SHIPPED / "phantom")
    assert session.synthetic
    assert len(session.trials) == 10
    assert session.support.kind == "hole"
    for trial in session.trials:
        assert trial.table.depth.max() <= PRESS + COUNT


def test_depth_comes_in_counts_and_noise_has_its_size_and_memory() -> None:
    generator = np.random.default_rng(1)
    press = one_press(np.array([0.0, 6e-3]), np.array([0.0, 0.0]), generator)
    counts = press.depth / COUNT
    np.testing.assert_allclose(counts, np.round(counts), atol=1e-9)
    noise = remembered_noise(200_000, generator)
    assert abs(np.std(noise) / NOISE - 1) < 0.02
    assert abs(np.corrcoef(noise[1:], noise[:-1])[0, 1] - 0.6) < 0.02


def test_the_same_seed_makes_the_same_trial() -> None:
    curve = (np.array([0.0, 6e-3]), np.array([0.0, 1.0]))
    first, second = (one_press(*curve, np.random.default_rng(7)) for _ in range(2))
    np.testing.assert_array_equal(first.force, second.force)
