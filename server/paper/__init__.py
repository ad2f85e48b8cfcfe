"""The reproduction report: studies over seeds, sweeps, and the document made of them."""
