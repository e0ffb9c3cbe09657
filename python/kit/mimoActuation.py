"""Stands in for MIMo's package ``mimoActuation`` where MIMo is not installed."""

from babybench_kit.standin import serve

serve(__name__)
