"""The node amcl: nav_algorithms' Monte Carlo localisation behind upstream's names."""
