"""Parcels: a run with all that it takes to repeat it elsewhere, in one folder."""
