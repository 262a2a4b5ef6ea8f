"""Measurements of Relume: what its paper reports, measured again, and the studies behind docs/factorization.md and
docs/layouts.md. `python3 -m relume.laboratory --help` lists them; docs/evaluation.md explains.

It needs python3-matplotlib and python3-jinja2, and the program `relume`.
"""
