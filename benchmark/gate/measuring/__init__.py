"""What runs inside a measured process: gated values, timed workloads, and the references beside them.

A process may measure another revision of the product, with this code put over it (see `child`). So this sub-package
knows the product by its public names only, takes plain commands and gives plain answers.
"""
