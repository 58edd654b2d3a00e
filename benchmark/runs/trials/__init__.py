"""A session's trials beside the models: base curves, films and their tables, what was measured, Table 1 of the article."""
