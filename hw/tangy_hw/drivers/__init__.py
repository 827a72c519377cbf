"""Device drivers: a module or group of modules for each kind, and their registry."""
