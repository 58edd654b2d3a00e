"""What is asked: layers, tool, support and discretisation, and whether they fit together. Nothing here computes."""
