"""What acts between bodies: tool and tissue, layer and layer, sheet and plate.

The way from a problem to them is in :mod:`fem.setup`.
"""
