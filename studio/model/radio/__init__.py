"""How radio carries: strength over distance, buildings, shadows, fading, errors, bursts of loss, a busy channel, cells.

Strengths are in dBm and dB, as tables and data sheets have them; distances in metres, times in seconds, sizes in bytes.
"""
