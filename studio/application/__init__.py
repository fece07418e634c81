"""Applications: their contract, and the hosts that call them."""
