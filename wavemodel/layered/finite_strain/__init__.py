"""A press at finite strain on a bonded base: the equilibrium of the neo-Hookean stack in the wave's own modes.

Nothing is calibrated. The displacement is made of the same modes as the linear wave, Bessel's round the tool's axis
and quadratic through the thickness, but strain and energy are those of finite deformation. The linear wave's stiffness
is the preconditioner, so that a path of load levels takes some tenths of a second, once; what a run adds to the linear
answer is read off a few fields.
"""
