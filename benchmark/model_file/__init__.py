"""`model.toml`: a base model with the effects that were found missing, written by `discover`, read by `--model`."""

from benchmark.model_file.reading import read_model
from benchmark.model_file.repaired_model import AddedEffect, RepairedModel, Value, model_toml

__all__ = ["AddedEffect", "RepairedModel", "Value", "model_toml", "read_model"]
