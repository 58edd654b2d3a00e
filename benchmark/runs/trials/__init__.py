"""A session's trials beside the models: base curves, films, what was measured, the article's Table 1."""
