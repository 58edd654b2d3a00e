"""Parameters of layers fitted to presses: moduli, thicknesses, laws and relaxation, and what the answer rests on.

`session_problem` puts sessions together, `layer_fit` fits, `identified` is the answer; `press_surrogate` is how a model
is asked, `layer_model` how a trial follows from it.
"""
