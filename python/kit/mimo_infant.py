"""Stands in for the package ``mimo_infant``, MIMo 3, where that is not installed."""

from babybench_kit.standin import serve

serve(__name__)
