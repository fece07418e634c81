"""Radio as it was measured on motorways, suburban roads and in towns: what the presets of the wlan are held against.

Delivery over distance of messages between cars on three kinds of road; losses in a row in one receiver's log, by distance; latency.
"""

DELIVERY = {  # share that arrives, by distance [m]
    "motorway": {100: 1.00, 200: 1.00, 300: 1.00, 400: 0.99, 500: 0.95, 600: 0.99, 800: 0.70, 1000: 0.49, 1500: 0.35},
    "suburban": {100: 0.99, 200: 0.97, 300: 0.83, 400: 0.73, 500: 0.55, 600: 0.29, 800: 0.20, 1000: 0.09},
    "urban": {100: 1.00, 200: 0.95, 300: 0.83, 400: 0.56, 500: 0.38, 600: 0.04, 800: 0.08, 1000: 0.00},
}
RUNS = {"150 to 200 m": (0.787, 12.2), "200 to 250 m": (0.698, 9.7), "300 to 350 m": (0.585, 4.9)}  # share that arrives, mean run of losses
LATENCY = {0.05: 0.0108, 0.50: 0.0163, 0.95: 0.0403, 0.99: 0.0495}  # [s] by quantile
