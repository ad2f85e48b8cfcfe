"""The operator's console: a viser server in a process of its own, which watches the walks of its server as any viewer does."""
