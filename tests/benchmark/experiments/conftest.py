from tests.benchmark.identification.parameters.conftest import toy, toy_fit

__all__ = ["toy", "toy_fit"]
