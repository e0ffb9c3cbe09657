"""The implementation of ``mimoEnv`` and its siblings, ``babybench.utils`` and ``babybench.eval``; import those."""
