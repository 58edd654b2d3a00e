"""A discovery as a folder: discovery.json, tables, model.toml, next_experiment.toml and the page."""
